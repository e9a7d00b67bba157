#include "tests/service/server_process.h"

#include <fcntl.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/support/client_interceptor.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace tribodyn::server {
namespace {

/// The token of the owner of the server at each address.
std::map<std::string, std::string>& tokens() {
  static std::map<std::string, std::string> all;
  return all;
}

/// Sends a token with every call of a channel.
class TokenAdder final : public grpc::experimental::ClientInterceptorFactoryInterface {
 public:
  explicit TokenAdder(const std::string& token) : authorization_("Bearer " + token) {}
  grpc::experimental::Interceptor* CreateClientInterceptor(
      grpc::experimental::ClientRpcInfo*) override {
    return new Adding(authorization_);  // gRPC deletes it
  }

 private:
  class Adding final : public grpc::experimental::Interceptor {
   public:
    explicit Adding(const std::string& authorization) : authorization_(authorization) {}
    void Intercept(grpc::experimental::InterceptorBatchMethods* methods) override {
      using Point = grpc::experimental::InterceptionHookPoints;
      if (methods->QueryInterceptionHookPoint(Point::PRE_SEND_INITIAL_METADATA)) {
        methods->GetSendInitialMetadata()->emplace("authorization", authorization_);
      }
      methods->Proceed();
    }

   private:
    const std::string authorization_;
  };
  const std::string authorization_;
};

}  // namespace

ServerProcess::ServerProcess(const std::vector<std::string>& arguments, std::string log,
                             int maximum_files, const std::string& program)
    : log_(std::move(log)), arguments_(arguments) {
  std::vector<std::string> words;
  if (maximum_files > 0) {
    words = {"/bin/sh", "-c", "ulimit -n " + std::to_string(maximum_files) + "; exec \"$@\"", "sh"};
  }
  words.push_back(program);
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO}) {
    posix_spawn_file_actions_addopen(&actions, descriptor, log_.c_str(),
                                     O_WRONLY | O_CREAT | O_APPEND, 0600);
  }
  const int failed =
      posix_spawn(&pid_, pointers.front(), &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw std::runtime_error("cannot start " + program);
}

ServerProcess::~ServerProcess() {
  if (!running()) return;
  kill(pid_, SIGKILL);
  wait();
}

void ServerProcess::signal(int number) const {
  if (exit_code_ < 0) kill(pid_, number);
}

bool ServerProcess::running() {
  if (exit_code_ >= 0) return false;
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) != pid_) return true;
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return false;
}

int ServerProcess::wait(std::chrono::seconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (running() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return exit_code_;
}

long ServerProcess::peak_memory_kibibytes() const {
  std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
  for (std::string word; status >> word;) {
    long value = 0;
    if (word == "VmHWM:" && status >> value) return value;
  }
  return -1;
}

std::string ServerProcess::log() const {
  std::ifstream file(log_);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string ServerProcess::flag(const std::string& name) const {
  const auto found = std::find(arguments_.begin(), arguments_.end(), name);
  return found == arguments_.end() || found + 1 == arguments_.end() ? "" : found[1];
}

std::string wait_for_address(const std::string& port_file, ServerProcess& process) {
  while (process.running()) {
    std::ifstream file(port_file);
    std::string line;
    if (std::getline(file, line)) {
      const std::string token = process.flag("--database") + ".token";
      setenv("TRIBODYN_TOKEN_FILE", token.c_str(), 1);
      tokens()[line] = owner_token();
      return line;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return {};
}

std::string owner_token() {
  const char* path = std::getenv("TRIBODYN_TOKEN_FILE");
  std::ifstream file(path == nullptr ? "" : path);
  std::string out;
  std::getline(file, out);
  return out;
}

std::shared_ptr<grpc::Channel> connect(const std::string& address, bool with_own_connection) {
  const auto token = tokens().find(address);
  return connect_with(address, token == tokens().end() ? "" : token->second, with_own_connection);
}

std::shared_ptr<grpc::Channel> connect_with(const std::string& address, const std::string& token,
                                            bool with_own_connection) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, with_own_connection ? 1 : 0);
  arguments.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  std::vector<std::unique_ptr<grpc::experimental::ClientInterceptorFactoryInterface>> interceptors;
  if (!token.empty()) interceptors.push_back(std::make_unique<TokenAdder>(token));
  return grpc::experimental::CreateCustomChannelWithInterceptors(
      address, grpc::InsecureChannelCredentials(), arguments, std::move(interceptors));
}

}  // namespace tribodyn::server
