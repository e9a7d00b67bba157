#include "server/application/authorizer.h"

#include <strings.h>

#include "server/application/errors.h"
#include "server/support/sha256.h"

namespace tribodyn::server {
namespace {

constexpr std::string_view kBearer = "Bearer ";
constexpr std::size_t kLongestAuthorization = 200;  // [bytes]; a token of this server has 82

/// What is hashed of a certificate begins so, and the secret of a token never does.
const std::string kOfCertificate = "certificate:";

/// Returns the secret in "Bearer SECRET"; nullopt for another form.
std::optional<std::string_view> secret_of(std::string_view authorization) {
  if (authorization.size() <= kBearer.size() || authorization.size() > kLongestAuthorization ||
      strncasecmp(authorization.data(), kBearer.data(), kBearer.size()) != 0) {
    return std::nullopt;
  }
  const std::string_view secret = authorization.substr(kBearer.size());
  if (secret.starts_with(kOfCertificate)) return std::nullopt;
  return secret;
}

}  // namespace

std::string token_hash(std::string_view secret) { return sha256(secret); }

std::optional<std::string> token_hash_of_bearer(std::string_view authorization) {
  const auto secret = secret_of(authorization);
  if (!secret) return std::nullopt;
  return token_hash(*secret);
}

std::string certificate_hash(std::string_view name) {
  return sha256(kOfCertificate + std::string(name));
}

void Authorizer::set_tokens(const std::vector<StoredToken>& tokens, Microseconds now) {
  {
    const std::lock_guard lock(mutex_);
    Grants next;
    for (const StoredToken& token : tokens) {
      if (!token.is_valid(now)) continue;
      const auto known = grants_.find(token.hash);
      // Only its end may differ from what the grant says already.
      if (known != grants_.end() && known->second->expire_time == token.expire_time) {
        next.emplace(token.hash, known->second);
        continue;
      }
      auto grant = std::make_shared<Grant>();
      grant->principal = token.name;
      grant->scope = token.scope;
      grant->projects = {token.projects.begin(), token.projects.end()};
      grant->expire_time = token.expire_time;
      grant->quota = {token.calls_per_second.value_or(quota_.calls_per_second),
                      token.streams.value_or(quota_.streams),
                      token.processor_hours.value_or(quota_.processor_hours)};
      if (token.name == kOwner) grant->quota = {};
      next.emplace(token.hash, std::move(grant));
    }
    for (const auto& [hash, grant] : grants_) {
      const auto kept = next.find(hash);
      if (kept == next.end() || kept->second != grant) grant->is_revoked = true;
    }
    grants_ = std::move(next);
  }
  observers_.tell();
}

Outcome<GrantPointer> Authorizer::authenticate(const Credentials& credentials,
                                               Microseconds now) const {
  if (credentials.is_owner) return owner_grant();
  std::string hash;
  if (!credentials.authorization.empty()) {
    const auto shown = token_hash_of_bearer(credentials.authorization);
    if (!shown) return unauthenticated("the header authorization is not \"Bearer TOKEN\"");
    hash = *shown;
  } else if (!credentials.certificate.empty()) {
    hash = certificate_hash(credentials.certificate);
  } else if (!credentials.token_hash.empty()) {
    hash = credentials.token_hash;
  } else {
    return unauthenticated("the call has no token");
  }
  const std::lock_guard lock(mutex_);
  const auto found = grants_.find(hash);
  if (found == grants_.end() || !found->second->is_valid(now)) return token_refused();
  return GrantPointer(found->second);
}

std::optional<google::rpc::Status> Authorizer::refuse_overview(const Credentials& credentials,
                                                               Microseconds now) const {
  const auto grant = authenticate(credentials, now);
  if (!grant.ok()) return grant.error();
  if (grant.message()->projects.empty()) return std::nullopt;
  return error(google::rpc::PERMISSION_DENIED, v1::ERROR_REASON_PROJECT_NOT_GRANTED,
               "this is about all projects, and the token is for some only", {{"project", "-"}});
}

}  // namespace tribodyn::server
