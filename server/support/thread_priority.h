#pragma once

namespace tribodyn::server {

/// How much lower the priority of working threads is, as a nice value. With 5 the threads that
/// receive and send messages get three times the share of a working thread: beside 20,000 refusals
/// the slowest health check took 33 and 20 ms instead of 47 and 48 ms (service_benchmark, two
/// cores, two runs each).
constexpr int kWorkNiceness = 5;

/// Lowers the priority of the calling thread, which carries out calls or computes, against those
/// that receive and send messages. Changes nothing where the system does not allow it.
void lower_priority_of_work();

}  // namespace tribodyn::server
