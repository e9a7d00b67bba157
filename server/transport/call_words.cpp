#include "server/transport/call_words.h"

#include <cstddef>
#include <cstdint>
#include <string>

#include "server/application/log_text.h"

namespace tribodyn::server {

CallContext call_context(const CallWords& words, std::chrono::nanoseconds left,
                         const std::atomic<bool>& cancelled) {
  constexpr std::size_t kLongest = 100;  // [bytes]
  static std::atomic<std::uint64_t> count = 0;
  return {.client = log_word(words.client.empty() ? words.peer : words.client, kLongest),
          .request_id = words.request_id.empty() ? std::to_string(++count)
                                                 : log_word(words.request_id, kLongest),
          .limits = {.deadline = CallLimits::Clock::now() +
                                 std::chrono::duration_cast<CallLimits::Clock::duration>(left),
                     .cancelled = &cancelled}};
}

}  // namespace tribodyn::server
