#include "server/application/wire_check.h"

#include <fmt/format.h>
#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/wire_format.h>

#include <memory>
#include <string>
#include <vector>

#include "server/application/element_limits.h"

namespace tribodyn::server {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::internal::WireFormat;
using google::protobuf::internal::WireFormatLite;
using google::protobuf::io::CodedInputStream;

/// Numbers of elements in one message. The wire may hold a singular message in several parts, which
/// parsing merges; so the counts of such a message are kept with the message around it.
struct ElementCounts {
  std::vector<std::int64_t> elements;                    // by index of the field; empty: none
  std::vector<std::unique_ptr<ElementCounts>> messages;  // by index of the field; empty: none
  std::int64_t unknown_fields = 0;
};

WireFormatLite::WireType wire_type_of(const FieldDescriptor& field) {
  return WireFormat::WireTypeForFieldType(field.type());
}

class WireScan {
 public:
  WireScan(CodedInputStream& in, Violations& violations) : in_(in), violations_(violations) {}

  /// Returns false if the bytes are not such a message.
  bool run(const Descriptor& type, int size) {
    ElementCounts counts;
    if (!read_part(type, size, counts)) return false;
    report(type, counts);
    if (violations_.empty() && total_ > kMaximumRequestElements) {
      violations_.push_back(
          {"", fmt::format("the request holds {} messages and texts in all; allowed: at most {}; "
                           "send it in parts",
                           total_, kMaximumRequestElements)});
    }
    return true;
  }

 private:
  /// Reads `size` bytes of a message.
  bool read_part(const Descriptor& type, int size, ElementCounts& counts) {
    const CodedInputStream::Limit outer = in_.PushLimit(size);
    bool is_whole = true;
    while (is_whole && in_.BytesUntilLimit() > 0) {
      const std::uint32_t tag = in_.ReadTag();
      is_whole = tag != 0 && read_field(type, tag, counts);
    }
    in_.PopLimit(outer);
    return is_whole;
  }

  bool read_field(const Descriptor& type, std::uint32_t tag, ElementCounts& counts) {
    const WireFormatLite::WireType wire_type = WireFormatLite::GetTagWireType(tag);
    const FieldDescriptor* field = type.FindFieldByNumber(WireFormatLite::GetTagFieldNumber(tag));
    const bool is_packed = field != nullptr && field->is_packable() &&
                           wire_type == WireFormatLite::WIRETYPE_LENGTH_DELIMITED;
    if (field != nullptr && (is_packed || wire_type == wire_type_of(*field))) {
      return is_packed ? read_packed(*field, counts) : read_known(*field, counts);
    }
    ++counts.unknown_fields;
    ++total_;
    return skip(wire_type);
  }

  bool read_packed(const FieldDescriptor& field, ElementCounts& counts) {
    int size = 0;
    if (!read_size(&size)) return false;
    const CodedInputStream::Limit outer = in_.PushLimit(size);
    const WireFormatLite::WireType wire_type = wire_type_of(field);
    bool is_whole = true;
    while (is_whole && in_.BytesUntilLimit() > 0) {
      ++count(field, counts);
      is_whole = skip(wire_type);
    }
    in_.PopLimit(outer);
    return is_whole;
  }

  bool read_known(const FieldDescriptor& field, ElementCounts& counts) {
    const bool is_message = field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
    if (is_message && !field.is_repeated()) return read_singular_message(field, counts);
    std::int64_t before = 0;
    if (field.is_repeated()) before = count(field, counts)++;
    const WireFormatLite::WireType wire_type = wire_type_of(field);
    if (wire_type != WireFormatLite::WIRETYPE_LENGTH_DELIMITED) return skip(wire_type);
    if (field.is_repeated()) ++total_;
    const std::optional<int> maximum = maximum_elements(field);
    if (!is_message || (maximum && before >= *maximum)) return skip(wire_type);
    int size = 0;
    if (!read_size(&size)) return false;
    ElementCounts inner;
    path_.push_back({&field, before});
    const bool is_whole = read_part(*field.message_type(), size, inner);
    report(*field.message_type(), inner);
    path_.pop_back();
    return is_whole;
  }

  bool read_singular_message(const FieldDescriptor& field, ElementCounts& counts) {
    int size = 0;
    if (!read_size(&size)) return false;
    const auto index = static_cast<std::size_t>(field.index());
    if (counts.messages.size() <= index) counts.messages.resize(index + 1);
    if (!counts.messages[index]) {
      counts.messages[index] = std::make_unique<ElementCounts>();
      ++total_;
    }
    path_.push_back({&field, kNoIndex});
    const bool is_whole = read_part(*field.message_type(), size, *counts.messages[index]);
    path_.pop_back();
    return is_whole;
  }

  static std::int64_t& count(const FieldDescriptor& field, ElementCounts& counts) {
    const auto index = static_cast<std::size_t>(field.index());
    if (counts.elements.size() <= index) counts.elements.resize(index + 1);
    return counts.elements[index];
  }

  bool read_size(int* size) {
    return in_.ReadVarintSizeAsInt(size) && *size <= in_.BytesUntilLimit();
  }

  /// Refuses groups: the contract has none.
  bool skip(WireFormatLite::WireType wire_type) {
    std::uint64_t number = 0;
    int size = 0;
    switch (wire_type) {
      case WireFormatLite::WIRETYPE_VARINT:
        return in_.ReadVarint64(&number);
      case WireFormatLite::WIRETYPE_FIXED64:
        return in_.Skip(8);
      case WireFormatLite::WIRETYPE_FIXED32:
        return in_.Skip(4);
      case WireFormatLite::WIRETYPE_LENGTH_DELIMITED:
        return read_size(&size) && in_.Skip(size);
      default:
        return false;
    }
  }

  void report(const Descriptor& type, const ElementCounts& counts) {
    for (std::size_t i = 0; i < counts.elements.size(); ++i) {
      const FieldDescriptor& field = *type.field(static_cast<int>(i));
      const std::optional<int> maximum = maximum_elements(field);
      if (!maximum || counts.elements[i] <= *maximum) continue;
      violations_.push_back(
          {join_path(path(), field.name()), too_many_text(counts.elements[i], *maximum)});
    }
    if (counts.unknown_fields > kMaximumUnknownFields) {
      violations_.push_back(
          {path(), fmt::format("{} fields that {} does not have; allowed: at most {}",
                               counts.unknown_fields, type.name(), kMaximumUnknownFields)});
    }
    for (std::size_t i = 0; i < counts.messages.size(); ++i) {
      if (!counts.messages[i]) continue;
      const FieldDescriptor& field = *type.field(static_cast<int>(i));
      path_.push_back({&field, kNoIndex});
      report(*field.message_type(), *counts.messages[i]);
      path_.pop_back();
    }
  }

  std::string path() const {
    std::string out;
    for (const auto& [field, index] : path_) {
      out = join_path(out, field->name());
      if (index != kNoIndex) out += fmt::format("[{}]", index);
    }
    return out;
  }

  static constexpr std::int64_t kNoIndex = -1;

  CodedInputStream& in_;
  Violations& violations_;
  std::vector<std::pair<const FieldDescriptor*, std::int64_t>> path_;  // to the current message
  std::int64_t total_ = 0;
};

}  // namespace

void check_wire(google::protobuf::io::ZeroCopyInputStream& bytes, int size, const Descriptor& type,
                Violations& violations) {
  CodedInputStream in(&bytes);
  if (!WireScan(in, violations).run(type, size)) violations.push_back(unreadable_violation(type));
}

Violation unreadable_violation(const Descriptor& type) {
  return {"",
          fmt::format("the request cannot be read: its bytes are not a {}, or a text in it is not "
                      "UTF-8",
                      type.name())};
}

}  // namespace tribodyn::server
