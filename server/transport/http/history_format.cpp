#include "server/transport/http/history_format.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "google/rpc/code.pb.h"
#include "server/transport/http/column_text.h"
#include "tribodyn/v1/campaigns.pb.h"
#include "tribodyn/v1/simulations.pb.h"

static_assert(std::endian::native == std::endian::little, "chunks are little-endian");

namespace tribodyn::server {
namespace {

using google::protobuf::Message;

std::vector<double> stored_values(const v1::HistoryChunk& chunk) {
  std::vector<double> out(chunk.values().size() / sizeof(double));
  std::memcpy(out.data(), chunk.values().data(), out.size() * sizeof(double));
  return out;
}

/// A part of a stream of columns: one of the two.
struct ColumnPart {
  const v1::HistorySchema* schema = nullptr;
  const v1::HistoryChunk* chunk = nullptr;
};

template <class Response>
ColumnPart part_of(const Message& message) {
  const auto& response = static_cast<const Response&>(message);
  if (response.has_chunk()) return {nullptr, &response.chunk()};
  return {&response.schema(), nullptr};
}

ColumnPart part_of(const Message& message) {
  return message.GetDescriptor() == v1::ReadCampaignResponse::descriptor()
             ? part_of<v1::ReadCampaignResponse>(message)
             : part_of<v1::ReadHistoryResponse>(message);
}

/// What all forms of a history share: the schema comes first, and an end is well or breaks off.
class HistoryFormat : public StreamFormat {
 public:
  HistoryFormat(Form form, AnyMessageSource::Order order) : form_(form), order_(order) {}

  AnyMessageSource::Order order() const final { return order_; }
  std::map<std::string, std::string> headers() const final {
    return {{"Content-Type", content_type(form_)}};
  }
  std::string part(const Message& message) final {
    const ColumnPart one = part_of(message);
    if (one.chunk != nullptr) return chunk_text(*one.chunk);
    schema_ = *one.schema;
    for (const auto& column : schema_.columns()) names_.push_back(column.name());
    std::string out = beginning();
    beginning_bytes_ = out.size();
    return out;
  }
  bool has_length() const final { return form_ == Form::kNumpy || form_ == Form::kBinary; }
  std::optional<std::uint64_t> length() const final {
    if (!has_length() || beginning_bytes_ == 0) return std::nullopt;
    return beginning_bytes_ +
           sizeof(double) * names_.size() * static_cast<std::uint64_t>(schema_.row_count());
  }
  std::optional<std::string> end(const google::rpc::Status& status) final {
    if (status.code() != google::rpc::OK) return std::nullopt;
    return ending();
  }

 protected:
  virtual std::string beginning() = 0;
  virtual std::string chunk_text(const v1::HistoryChunk& chunk) = 0;
  virtual std::string ending() { return {}; }

  /// The members that describe the rows, as JSON without braces.
  std::string json_of_rows() const {
    return "\"start_row\":" + std::to_string(schema_.start_row()) +
           ",\"row_count\":" + std::to_string(schema_.row_count()) +
           ",\"total_rows\":" + std::to_string(schema_.total_rows()) +
           ",\"rows_per_pair\":" + std::to_string(schema_.rows_per_pair());
  }
  std::string json_of_units() const {
    std::string out;
    for (const auto& column : schema_.columns()) {
      out += (out.empty() ? "\"" : ",\"") + column.name() + "\":\"" + column.unit() + '"';
    }
    return "{" + out + "}";
  }

  v1::HistorySchema schema_;
  std::vector<std::string> names_;

 private:
  const Form form_;
  const AnyMessageSource::Order order_;
  std::size_t beginning_bytes_ = 0;  // 0 before the schema
};

/// Rows of all columns: CSV and NumPy.
class RowFormat final : public HistoryFormat {
 public:
  explicit RowFormat(bool is_csv)
      : HistoryFormat(is_csv ? Form::kCsv : Form::kNumpy, AnyMessageSource::Order::kRows),
        is_csv_(is_csv) {}

 private:
  std::string beginning() override {
    return is_csv_ ? csv_header(names_) : numpy_header(names_, schema_.row_count());
  }
  std::string chunk_text(const v1::HistoryChunk& chunk) override {
    run_.push_back(stored_values(chunk));
    if (run_.size() < names_.size()) return {};
    const Columns run = std::exchange(run_, {});
    return is_csv_ ? csv_rows(run) : numpy_rows(run);
  }

  const bool is_csv_;
  Columns run_;  // chunks of the first columns of a run
};

/// {"start_row", ..., "units": {name: unit}, "columns": {name: [values]}}
class JsonColumnsFormat final : public HistoryFormat {
 public:
  JsonColumnsFormat() : HistoryFormat(Form::kColumns, AnyMessageSource::Order::kColumns) {}

 private:
  std::string beginning() override {
    return "{" + json_of_rows() + ",\"units\":" + json_of_units() + ",\"columns\":{";
  }
  std::string chunk_text(const v1::HistoryChunk& chunk) override {
    std::string out;
    if (chunk.first_row() == 0) {
      out = begun_ == 0 ? "\"" : "],\"";
      out += names_[begun_++] + "\":[";
    }
    for (const double value : stored_values(chunk)) {
      if (out.empty() || out.back() != '[') out += ',';
      append_json_number(value, out);
    }
    return out;
  }
  std::string ending() override {
    std::string out = begun_ > 0 ? "]" : "";
    for (std::size_t i = begun_; i < names_.size(); ++i) {  // without any row
      out += (i > 0 ? ",\"" : "\"") + names_[i] + "\":[]";
    }
    return out + "}}\n";
  }

  std::size_t begun_ = 0;  // columns
};

/// The length of a JSON text in four bytes, the text padded with blanks to a multiple of eight
/// bytes in all, then the columns one after another.
class BinaryFormat final : public HistoryFormat {
 public:
  BinaryFormat() : HistoryFormat(Form::kBinary, AnyMessageSource::Order::kColumns) {}

 private:
  std::string beginning() override {
    std::string list;
    for (const std::string& name : names_) list += (list.empty() ? "\"" : ",\"") + name + '"';
    std::string json =
        "{" + json_of_rows() + ",\"units\":" + json_of_units() + ",\"columns\":[" + list + "]}";
    const std::size_t before = sizeof(std::uint32_t) + json.size();
    json.append((sizeof(double) - before % sizeof(double)) % sizeof(double), ' ');
    const auto length = static_cast<std::uint32_t>(json.size());
    std::string out(sizeof length, '\0');
    std::memcpy(out.data(), &length, sizeof length);
    return out + json;
  }
  std::string chunk_text(const v1::HistoryChunk& chunk) override { return chunk.values(); }
};

}  // namespace

std::unique_ptr<StreamFormat> history_format(Form form) {
  switch (form) {
    case Form::kCsv:
      return std::make_unique<RowFormat>(true);
    case Form::kNumpy:
      return std::make_unique<RowFormat>(false);
    case Form::kBinary:
      return std::make_unique<BinaryFormat>();
    default:
      return std::make_unique<JsonColumnsFormat>();
  }
}

}  // namespace tribodyn::server
