// libFuzzer: sends hostile requests that parse through the application layer over a database with
// the seeds. Each must be answered or refused with a reason; none may crash, hang, end in INTERNAL
// or leave a database that cannot be read. An input is text: the method's name, then the request in
// protobuf's text format. Requests are changed field by field (HostileMessages), not byte by byte.
// Most are only validated, because a server with a new database takes longer than many requests.
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "google/rpc/code.pb.h"
#include "server/application/simulations.h"
#include "tests/fuzz/fuzzed_server.h"
#include "tests/service/resource_calls.h"
#include "tests/support/hostile_message.h"

namespace tribodyn::server {
namespace {

using google::protobuf::Message;
using google::protobuf::TextFormat;

constexpr std::size_t kWrittenOneIn = 8;           // one in so many writing requests really writes
constexpr std::size_t kMostChanges = 4;            // changes of one mutation
constexpr std::size_t kLargestRefusal = 8 * 1024;  // [bytes], limit of headers in gRPC clients
constexpr std::size_t kLargestAnswer = 16 * 1024 * 1024;  // [bytes], limit of GrpcServer

/// Returns the server in its initial state, so that an input does not depend on writes of earlier
/// ones.
std::unique_ptr<FuzzedServer>& server() {
  static std::unique_ptr<FuzzedServer> kServer;
  if (!kServer) {
    spdlog::set_level(spdlog::level::off);
    kServer = std::make_unique<FuzzedServer>();
  }
  return kServer;
}

void judge_refusal(const google::rpc::Status& status) {
  require(status.code() != google::rpc::INTERNAL && status.code() != google::rpc::UNKNOWN &&
          status.code() != google::rpc::OK && status.code() != google::rpc::DATA_LOSS);
  require(!status.message().empty());
  require(status.ByteSizeLong() <= kLargestRefusal);
}

bool judge(const Outcome<Reply>& outcome) {
  if (!outcome.ok()) {
    judge_refusal(outcome.error());
    return false;
  }
  require(outcome.message()->ByteSizeLong() <= kLargestAnswer);
  return true;
}

/// A method: its request, and a call that checks the answer and returns true if the request was
/// accepted.
struct FuzzedMethod {
  const Message* prototype;
  std::function<bool(Application&, const Message&)> call;
  bool writes = false;
};

/// The methods whose requests are made, by their rows.
const std::map<std::string, FuzzedMethod>& methods() {
  static const std::set<std::string> kNames = {"CreateSimulation",      "ListSimulations",
                                               "EvaluateContact",       "GetSchema",
                                               "CreateLubricant",       "UpdateLubricant",
                                               "BatchCreateLubricants", "BatchUpdateLubricants",
                                               "ListLubricants",        "ListLubricantRevisions",
                                               "GetLubricant",          "DeleteLubricant",
                                               "UndeleteLubricant",     "GetGearSet",
                                               "UpdateGearSet",         "BatchCreateSurfaces",
                                               "ListSurfaces",          "UpdateVehicle",
                                               "ListVehicles"};
  static const std::map<std::string, FuzzedMethod> kMethods = [] {
    std::map<std::string, FuzzedMethod> out;
    for (const Method& row : method_table()) {
      if (!kNames.contains(row.descriptor->name())) continue;
      const bool writes = row.lane == CallLane::kWrite || row.lane == CallLane::kHeavy;
      out[row.descriptor->name()] = {
          row.request,
          [row](Application& application, const Message& request) {
            return judge(guarded<Reply>(
                [&] { return row.answer(application, request, {.client = "fuzzer"}); }));
          },
          writes};
    }
    return out;
  }();
  return kMethods;
}

/// Checks that every list can still be read, page by page.
void read_everything(Application& application) {
  const auto all_pages = [&](auto list, auto request) {
    request.set_page_size(2);
    for (int pages = 0; pages < 1000; ++pages) {
      const auto outcome = list(application, request, CallContext());
      require(outcome.ok());
      request.set_page_token(outcome.message().next_page_token());
      if (request.page_token().empty()) return;
    }
    std::abort();  // endless pages
  };
  v1::ListLubricantsRequest lubricants;
  lubricants.set_show_deleted(true);
  lubricants.set_order_by("display_name desc");
  all_pages(list_lubricants, lubricants);
  all_pages(list_gear_sets, v1::ListGearSetsRequest());
  all_pages(list_surfaces, v1::ListSurfacesRequest());
  all_pages(list_vehicles, v1::ListVehiclesRequest());
  all_pages(list_simulations, v1::ListSimulationsRequest());
}

class NoComplaints : public google::protobuf::io::ErrorCollector {
 public:
  void AddError(int, google::protobuf::io::ColumnNumber, const std::string&) override {}
};

/// A parsed input.
struct Input {
  std::string name;
  const FuzzedMethod* method = nullptr;
  std::unique_ptr<Message> request;

  std::string text() const {
    std::string out;
    TextFormat::PrintToString(*request, &out);
    return name + "\n" + out;
  }
};

/// Parses an input. The result has no request if the text names no method or is not a request of
/// the method.
Input parse(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  Input out;
  const std::size_t end = std::min(text.find('\n'), text.size());
  out.name = text.substr(0, end);
  const auto found = methods().find(out.name);
  if (found == methods().end()) return out;
  out.method = &found->second;
  std::unique_ptr<Message> request(out.method->prototype->New());
  NoComplaints quiet;
  TextFormat::Parser parser;
  parser.RecordErrorsTo(&quiet);
  if (parser.ParseFromString(text.substr(std::min(end + 1, text.size())), request.get())) {
    out.request = std::move(request);
  }
  return out;
}

/// Sets the field that makes a request only validate. Returns false if it has no such field.
bool only_validate(Message& request) {
  const auto* field = request.GetDescriptor()->FindFieldByName("validate_only");
  if (field != nullptr) request.GetReflection()->SetBool(&request, field, true);
  return field != nullptr;
}

std::size_t copy_out(const Input& input, std::uint8_t* data, std::size_t size,
                     std::size_t maximum_size) {
  const std::string text = input.text();
  if (text.size() > maximum_size) return size;  // unchanged
  std::memcpy(data, text.data(), text.size());
  return text.size();
}

}  // namespace
}  // namespace tribodyn::server

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tribodyn::server;
  const Input input = parse(data, size);
  if (!input.request) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  // The choice depends on the input, so that a crash can be repeated.
  const bool is_chosen = std::hash<std::string_view>()(text) % kWrittenOneIn == 0;
  const bool writes = input.method->writes && (is_chosen || !only_validate(*input.request));
  const bool accepted = input.method->call(server()->application(), *input.request);
  if (accepted && writes) {
    read_everything(server()->application());
    server().reset();
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t maximum_size, unsigned int seed) {
  using namespace tribodyn::server;
  Input input = parse(data, size);
  if (!input.request) {  // the first input of a run without a corpus
    auto chosen = methods().begin();
    std::advance(chosen, seed % methods().size());
    input.name = chosen->first;
    input.request.reset(chosen->second.prototype->New());
  }
  tribodyn::HostileMessages hostile(seed);
  for (std::size_t changes = 1 + seed % kMostChanges; changes > 0; --changes) {
    hostile.mutate(*input.request);
  }
  return copy_out(input, data, size, maximum_size);
}

extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* data, std::size_t size,
                                                 const std::uint8_t* other, std::size_t other_size,
                                                 std::uint8_t* out, std::size_t maximum_size,
                                                 unsigned int seed) {
  using namespace tribodyn::server;
  Input input = parse(data, size);
  const Input source = parse(other, other_size);
  if (!input.request || !source.request || input.name != source.name) return 0;
  tribodyn::HostileMessages(seed).graft(*source.request, *input.request);
  return copy_out(input, out, 0, maximum_size);
}
