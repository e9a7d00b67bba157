#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/storage/stored_token.h"
#include "server/transport/tls_files.h"

namespace tribodyn::server {

// Exit codes; scripts that start the server use them.
inline constexpr int kExitStopped = 0;
inline constexpr int kExitFailed = 1;
inline constexpr int kExitBadSettings = 2;
inline constexpr int kExitBadDatabase = 3;
inline constexpr int kExitCannotListen = 4;
inline constexpr int kExitWrongResults = 5;
inline constexpr int kExitOtherVersion = 6;  // another version wrote the database

/// What `tribodynd tokens` is to do.
struct TokenSettings {
  std::string action;  ///< "create", "list", "revoke", "rotate"
  std::string name;    ///< of the principal
  Scope scope = Scope::kWrite;
  std::vector<std::string> projects;       ///< empty: all
  double expire_days = 90;                 ///< 0: never
  std::optional<double> calls_per_second;  ///< its quotas; without one: the server's
  std::optional<int> streams;
  std::optional<double> processor_hours;
  bool of_certificate = false;  ///< for those whose certificates have the name; no secret
  double overlap_hours = 0;     ///< that the replaced token stays valid
};

/// Settings of the server. A value comes from its flag, or else from the environment
/// (TRIBODYND_LISTEN for --listen), or else from the file of --config, or else it is the default
/// below.
struct Settings {
  std::string command;  ///< empty: serve; "backup", "restore", "check", "tokens"
  std::string file;     ///< argument of backup and restore
  TokenSettings token;  ///< of "tokens"
  bool check_only = false;
  std::string listen;  ///< addresses, with commas between them; empty: default_addresses()
  TlsFiles tls;
  std::string database;
  int threads = 0;
  std::vector<std::string> projects;  ///< beside `default`
  std::string port_file;
  std::string http_listen;  ///< addresses like listen; empty: no REST interface and no metrics
  std::string dashboard;    ///< folder; empty: default_dashboard_folder()
  std::string log_level = "info";
  double call_limit_seconds = 30;
  double stream_limit_seconds = 3600;
  double unread_limit_seconds = 60;
  double heartbeat_seconds = 15;
  double drain_seconds = 20;
  double keep_days = 0;              ///< 0: no limit
  double disk_budget_megabytes = 0;  ///< for simulations that may be removed; 0: no limit
  double waiting_processor_hours = 100;
  int waiting_simulations = 20'000;
  // Quotas of each principal but the owner, and of each project; 0: no limit.
  double principal_calls_per_second = 200;
  int principal_streams = 200;
  double principal_processor_hours = 0;
  double project_calls_per_second = 0;
  int project_streams = 0;
  double project_processor_hours = 0;
  double project_megabytes = 0;
};

/// Reads settings. Returns nullopt if the process must end with `exit_code`: help or an error was
/// printed.
std::optional<Settings> read_settings(const std::vector<std::string>& arguments, int* exit_code);

}  // namespace tribodyn::server
