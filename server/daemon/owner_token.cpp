#include "server/daemon/owner_token.h"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "server/application/authorizer.h"
#include "server/storage/durable_files.h"
#include "server/storage/store_error.h"
#include "server/support/random_bytes.h"

namespace tribodyn::server {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSecretBytes = 32;
constexpr std::size_t kShortestSecret = 32;  // [characters]; a file with less holds no token
constexpr std::size_t kLongestSecret = 128;  // [characters]

StoreError token_file_error(const fs::path& file, const std::string& why) {
  return {StoreError::Kind::kCannotOpen, "token file " + file.string() + " " + why};
}

StoreError failed(const fs::path& file, const char* what) {
  return token_file_error(
      file, std::string("cannot be ") + what + ": " + std::generic_category().message(errno));
}

/// Closes its descriptor.
struct OpenFile {
  int descriptor;
  ~OpenFile() {
    if (descriptor >= 0) close(descriptor);
  }
};

/// Returns the first line of the file; nullopt if there is no file.
std::optional<std::string> read_secret(const fs::path& path) {
  const OpenFile file{open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK)};
  if (file.descriptor < 0 && errno == ENOENT) return std::nullopt;
  if (file.descriptor < 0) throw failed(path, "read");
  struct stat found {};
  if (fstat(file.descriptor, &found) != 0) throw failed(path, "read");
  if (!S_ISREG(found.st_mode) || found.st_uid != geteuid() || (found.st_mode & 077) != 0) {
    throw token_file_error(path,
                           "may be read or written by others; if nobody has read it, set its "
                           "owner and chmod 600, else remove it: the server makes a new one");
  }
  std::string text(kLongestSecret, '\0');
  const ssize_t count = read(file.descriptor, text.data(), text.size());
  if (count < 0) throw failed(path, "read");
  text.resize(static_cast<std::size_t>(count));
  text.resize(std::min(text.find_first_of(" \r\n"), text.size()));
  if (text.size() < kShortestSecret) {
    throw token_file_error(path, "holds no token; remove it: the server makes a new one");
  }
  return text;
}

}  // namespace

fs::path owner_token_file(const fs::path& database) { return database.string() + ".token"; }

std::string new_secret() {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string out = "tribodyn_";
  for (const char each : random_bytes(kSecretBytes)) {
    const auto byte = static_cast<unsigned char>(each);
    out += kDigits[byte >> 4U];
    out += kDigits[byte & 15U];
  }
  return out;
}

void write_owner_token(const fs::path& database, const std::string& secret) {
  replace_file(owner_token_file(database), secret + "\n");
}

void provide_owner_token(TokenTable& tokens, const fs::path& database, Microseconds now) {
  std::optional<std::string> secret = read_secret(owner_token_file(database));
  if (!secret) {
    secret = new_secret();
    write_owner_token(database, *secret);
  }
  const StoredToken token{
      .name = kOwner, .hash = token_hash(*secret), .scope = Scope::kAdmin, .create_time = now};
  const std::vector<StoredToken> all = tokens.all();
  const auto known = std::find_if(all.begin(), all.end(), [&token](const StoredToken& each) {
    return each.hash == token.hash;
  });
  if (known == all.end()) {
    if (!tokens.replace(token, now)) tokens.add(token);
  } else if (!known->is_valid(now)) {
    spdlog::warn("the token of {} is no longer valid; remove the file for a new one",
                 owner_token_file(database).string());
  }
}

}  // namespace tribodyn::server
