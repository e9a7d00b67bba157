#include "server/daemon/token_command.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <string>
#include <thread>

#include "server/application/audit_log.h"
#include "server/application/authorizer.h"
#include "server/daemon/owner_token.h"
#include "server/storage/session_file.h"
#include "server/storage/store.h"
#include "server/storage/token_table.h"

namespace tribodyn::server {
namespace {

constexpr auto kAcknowledgeLimit = std::chrono::seconds(10);
constexpr auto kAcknowledgePause = std::chrono::milliseconds(10);
constexpr double kMicrosecondsPerHour = 3600e6;

int refuse(const std::string& sentence) {
  fmt::print(stderr, "tribodynd: {}\n", sentence);
  return kExitFailed;
}

/// Brings a database without a server to the present schema. Returns true if a server uses it.
bool has_server(const std::string& database) try {
  if (!std::filesystem::exists(database)) {
    throw StoreError(StoreError::Kind::kCannotOpen,
                     "there is no database " + database + "; start tribodynd once to make it");
  }
  const Store store(database);
  return false;
} catch (const StoreError& error) {
  if (error.kind() != StoreError::Kind::kInUse) throw;
  return true;
}

/// Returns kExitStopped when the server applies all changes, and kExitFailed if it does not within
/// kAcknowledgeLimit.
int wait_for_server(TokenTable& tokens) {
  const auto end = std::chrono::steady_clock::now() + kAcknowledgeLimit;
  while (tokens.acknowledged_change() < tokens.change()) {
    if (std::chrono::steady_clock::now() > end) {
      return refuse(
          "the change is stored, but the running server does not apply it; stop that server, and "
          "the change holds from its next start");
    }
    std::this_thread::sleep_for(kAcknowledgePause);
  }
  return kExitStopped;
}

std::string date(Microseconds time) {
  const std::time_t of_epoch = time / 1'000'000;
  std::tm parts{};
  gmtime_r(&of_epoch, &parts);
  return fmt::format("{:%Y-%m-%d %H:%M}", parts);
}

std::string scope_text(Scope scope) {
  return scope == Scope::kRead ? "read" : scope == Scope::kWrite ? "write" : "admin";
}

std::string state_text(const StoredToken& token, Microseconds now) {
  if (token.revoke_time) return "revoked " + date(*token.revoke_time);
  if (!token.is_valid(now)) return "expired " + date(*token.expire_time);
  return token.expire_time ? "until " + date(*token.expire_time) : "valid";
}

/// The quotas that a token has of its own.
std::string quota_text(const StoredToken& token) {
  std::string out;
  if (token.calls_per_second) out += fmt::format(", {:g} calls/s", *token.calls_per_second);
  if (token.streams) out += fmt::format(", {} streams", *token.streams);
  if (token.processor_hours) out += fmt::format(", {:g} processor hours", *token.processor_hours);
  return out;
}

void list_tokens(TokenTable& tokens, Microseconds now) {
  fmt::print("{:<24} {:<6} {:<24} {:<17} {}\n", "NAME", "SCOPE", "PROJECTS", "CREATED (UTC)",
             "STATE");
  for (const StoredToken& each : tokens.all()) {
    fmt::print("{:<24} {:<6} {:<24} {:<17} {}\n", each.name, scope_text(each.scope),
               each.projects.empty() ? "all" : fmt::format("{}", fmt::join(each.projects, ",")),
               date(each.create_time), state_text(each, now) + quota_text(each));
  }
}

StoredToken token_of(const TokenSettings& settings, const std::string& secret, Microseconds now) {
  StoredToken out{
      .name = settings.name,
      .hash = settings.of_certificate ? certificate_hash(settings.name) : token_hash(secret),
      .scope = settings.scope,
      .projects = settings.projects,
      .create_time = now,
      .calls_per_second = settings.calls_per_second,
      .streams = settings.streams,
      .processor_hours = settings.processor_hours};
  if (settings.expire_days > 0) {
    out.expire_time =
        now + static_cast<Microseconds>(24 * kMicrosecondsPerHour * settings.expire_days);
  }
  return out;
}

/// The valid token of a name that was made last; nullopt if there is none.
std::optional<StoredToken> valid_token(TokenTable& tokens, const std::string& name,
                                       Microseconds now) {
  std::optional<StoredToken> out;
  for (StoredToken& each : tokens.all()) {
    if (each.name == name && each.is_valid(now)) out = std::move(each);
  }
  return out;
}

}  // namespace

int change_tokens(const Settings& settings) {
  const TokenSettings& asked = settings.token;
  const bool is_served = has_server(settings.database);
  TokenTable tokens(settings.database);
  const Microseconds now = system_time();
  const std::string secret = new_secret();
  if (asked.action == "list") {
    list_tokens(tokens, now);
    return kExitStopped;
  }
  if (asked.action == "end-sessions") {
    SessionFile::renew(settings.database);
  } else if (asked.action == "revoke") {
    if (tokens.revoke(asked.name, now) == 0) return refuse(asked.name + " has no valid token");
  } else if (asked.action == "create") {
    for (const StoredToken& each : tokens.all()) {
      if (asked.of_certificate && each.hash == certificate_hash(asked.name)) {
        return refuse(asked.name +
                      " was granted to a certificate before, which would be valid again; make the "
                      "new certificate under another name");
      }
    }
    if (!tokens.add(token_of(asked, secret, now))) {
      return refuse(asked.name + " has a valid token; rotate or revoke it, or use another name");
    }
  } else {
    const auto present = valid_token(tokens, asked.name, now);
    if (!present) return refuse(asked.name + " has no valid token");
    if (present->hash == certificate_hash(asked.name)) {
      return refuse(asked.name + " uses a certificate; give out a new certificate instead");
    }
    StoredToken next = token_of(asked, secret, now);
    next.scope = present->scope;
    next.projects = present->projects;
    next.calls_per_second = present->calls_per_second;
    next.streams = present->streams;
    next.processor_hours = present->processor_hours;
    if (asked.name == kOwner) {
      next.expire_time = {};
      write_owner_token(settings.database, secret);
    }
    tokens.replace(next,
                   now + static_cast<Microseconds>(kMicrosecondsPerHour * asked.overlap_hours));
  }
  CallContext command{.client = "tribodynd-tokens", .request_id = "-"};
  AuditLog(settings.database + ".audit").record(command, "tokens-" + asked.action, {}, asked.name);
  const int out = is_served ? wait_for_server(tokens) : kExitStopped;
  const bool has_secret = (asked.action == "create" || asked.action == "rotate") &&
                          asked.name != kOwner && !asked.of_certificate;
  if (has_secret) fmt::print("{}\n", secret);
  return out;
}

}  // namespace tribodyn::server
