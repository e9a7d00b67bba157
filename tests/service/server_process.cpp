#include "tests/service/server_process.h"

#include <fcntl.h>
#include <grpcpp/create_channel.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace tribodyn::server {

ServerProcess::ServerProcess(const std::vector<std::string>& arguments, std::string log,
                             int maximum_files, const std::string& program)
    : log_(std::move(log)) {
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

std::string wait_for_address(const std::string& port_file, ServerProcess& process) {
  while (process.running()) {
    std::ifstream file(port_file);
    std::string line;
    if (std::getline(file, line)) return line;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return {};
}

std::shared_ptr<grpc::Channel> connect(const std::string& address) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  return grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments);
}

}  // namespace tribodyn::server
