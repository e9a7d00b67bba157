#include "server/support/thread_priority.h"

#include <sys/resource.h>
#include <unistd.h>

namespace tribodyn::server {

void lower_priority_of_work() {
  const auto thread = static_cast<id_t>(gettid());  // Linux keeps a nice value for each thread
  setpriority(PRIO_PROCESS, thread, getpriority(PRIO_PROCESS, thread) + kWorkNiceness);
}

}  // namespace tribodyn::server
