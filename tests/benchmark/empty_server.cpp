// usage: empty_server PORT_FILE      Serves GetSimulation and ReadHistory of the contract with
// nothing behind them, until standard input ends: an empty answer, and as many chunks of 256 KiB of
// zeros as row_count says. What a server that does its work is compared with. Writes its address to
// the file.
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tribodyn/v1/simulations.grpc.pb.h"

namespace tribodyn {
namespace {

constexpr std::size_t kChunkBytes = 262'144;

class Chunks final : public grpc::ServerWriteReactor<v1::ReadHistoryResponse> {
 public:
  explicit Chunks(std::int64_t count) : left_(count) { next(); }
  void OnWriteDone(bool ok) override {
    if (!ok) left_ = 0;
    next();
  }
  void OnDone() override { delete this; }

 private:
  void next() {
    if (left_-- <= 0) return Finish(grpc::Status::OK);
    part_.mutable_chunk()->mutable_values()->assign(kChunkBytes, '\0');
    StartWrite(&part_);
  }

  std::int64_t left_;
  v1::ReadHistoryResponse part_;
};

class EmptySimulations final : public v1::SimulationService::CallbackService {
  grpc::ServerUnaryReactor* GetSimulation(grpc::CallbackServerContext* context,
                                          const v1::GetSimulationRequest*,
                                          v1::Simulation*) override {
    grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
    reactor->Finish(grpc::Status::OK);
    return reactor;
  }
  grpc::ServerWriteReactor<v1::ReadHistoryResponse>* ReadHistory(
      grpc::CallbackServerContext*, const v1::ReadHistoryRequest* request) override {
    return new Chunks(request->row_count());  // deletes itself
  }
};

int run(const std::string& port_file) {
  EmptySimulations service;
  grpc::ServerBuilder builder;
  int port = 0;
  builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
  builder.RegisterService(&service);
  const auto server = builder.BuildAndStart();
  if (!server) return 1;
  std::ofstream(port_file + ".new") << "127.0.0.1:" << port << '\n';
  std::filesystem::rename(port_file + ".new", port_file);
  char byte = 0;
  while (read(STDIN_FILENO, &byte, 1) > 0) {
  }
  server->Shutdown(std::chrono::system_clock::now());
  return 0;
}

}  // namespace
}  // namespace tribodyn

int main(int argc, char** argv) { return argc == 2 ? tribodyn::run(argv[1]) : 2; }
