#include "server/contract/parse_fields.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/wire_format_lite.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

namespace tribodyn::server {

bool parse_fields(std::string_view bytes, std::initializer_list<int> numbers,
                  google::protobuf::Message& out) {
  using google::protobuf::internal::WireFormatLite;
  google::protobuf::io::CodedInputStream in(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                                            static_cast<int>(bytes.size()));
  std::string kept;
  for (;;) {
    const auto begin = static_cast<std::size_t>(in.CurrentPosition());
    const std::uint32_t tag = in.ReadTag();
    if (tag == 0) break;
    if (!WireFormatLite::SkipField(&in, tag)) return false;
    const auto end = static_cast<std::size_t>(in.CurrentPosition());
    const int number = WireFormatLite::GetTagFieldNumber(tag);
    if (std::find(numbers.begin(), numbers.end(), number) != numbers.end()) {
      kept += bytes.substr(begin, end - begin);
    }
  }
  return in.ConsumedEntireMessage() && out.ParseFromString(kept);
}

}  // namespace tribodyn::server
