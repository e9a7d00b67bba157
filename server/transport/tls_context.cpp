#include "server/transport/tls_context.h"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <exception>
#include <utility>

#include "server/transport/listen_address.h"

namespace tribodyn::server {
namespace {

constexpr auto kTlsReloadInterval = std::chrono::seconds(2);  // as that of gRPC's files
constexpr char kTls12Ciphers[] = "ECDHE+AESGCM:ECDHE+CHACHA20";

void require(bool is_done, const std::string& file) {
  if (is_done) return;
  ERR_clear_error();
  throw ListenError("the TLS file " + file + " cannot be used");
}

std::shared_ptr<SSL_CTX> read_context(const TlsFiles& files) {
  require_usable(files);
  std::shared_ptr<SSL_CTX> out(SSL_CTX_new(TLS_server_method()), SSL_CTX_free);
  if (!out) throw std::bad_alloc();
  SSL_CTX* context = out.get();
  SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION);
  SSL_CTX_set_cipher_list(context, kTls12Ciphers);
  // Without sessions every handshake reads the client's certificate again.
  SSL_CTX_set_session_cache_mode(context, SSL_SESS_CACHE_OFF);
  SSL_CTX_set_num_tickets(context, 0);
  SSL_CTX_set_options(context, SSL_OP_NO_TICKET | SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION |
                                   SSL_OP_CIPHER_SERVER_PREFERENCE);
  SSL_CTX_set_default_passwd_cb(context, [](char*, int, int, void*) { return -1; });
  require(SSL_CTX_use_certificate_chain_file(context, files.certificate.c_str()) == 1,
          files.certificate);
  require(SSL_CTX_use_PrivateKey_file(context, files.key.c_str(), SSL_FILETYPE_PEM) == 1,
          files.key);
  if (files.client_authorities.empty()) return out;
  const char* authorities = files.client_authorities.c_str();
  require(SSL_CTX_load_verify_locations(context, authorities, nullptr) == 1,
          files.client_authorities);
  auto* names = SSL_load_client_CA_file(authorities);
  require(names != nullptr, files.client_authorities);
  SSL_CTX_set_client_CA_list(context, names);
  SSL_CTX_set_verify(context, SSL_VERIFY_PEER | SSL_VERIFY_FAIL_IF_NO_PEER_CERT, nullptr);
  return out;
}

}  // namespace

TlsContext::TlsContext(TlsFiles files)
    : files_(std::move(files)),
      read_(states()),
      context_(read_context(files_)),
      checked_(std::chrono::steady_clock::now()) {}

TlsContext::States TlsContext::states() const {
  States out{};
  std::size_t i = 0;
  for (const std::string* path : {&files_.certificate, &files_.key, &files_.client_authorities}) {
    struct stat found {};
    if (stat(path->c_str(), &found) == 0) {
      out[i] = {static_cast<std::int64_t>(found.st_ino), found.st_size, found.st_mtim.tv_sec,
                found.st_mtim.tv_nsec};
    }
    ++i;
  }
  return out;
}

std::shared_ptr<ssl_ctx_st> TlsContext::current() {
  const auto now = std::chrono::steady_clock::now();
  if (now - checked_ < kTlsReloadInterval) return context_;
  checked_ = now;
  const States present = states();
  if (present == read_) return context_;
  try {
    context_ = read_context(files_);
    read_ = present;
    spdlog::info("event=tls_files_read certificate=\"{}\"", files_.certificate);
  } catch (const std::exception& failure) {  // tried again after the interval
    spdlog::warn("event=tls_files_not_read cause=\"{}\"", failure.what());
  }
  return context_;
}

std::string certificate_name(const ssl_st* connection) {
  const std::unique_ptr<X509, decltype(&X509_free)> certificate(
      SSL_get1_peer_certificate(connection), X509_free);
  if (!certificate) return {};
  X509_NAME* subject = X509_get_subject_name(certificate.get());
  const int place = X509_NAME_get_index_by_NID(subject, NID_commonName, -1);
  if (place < 0) return {};
  unsigned char* text = nullptr;
  const int length =
      ASN1_STRING_to_UTF8(&text, X509_NAME_ENTRY_get_data(X509_NAME_get_entry(subject, place)));
  if (length < 0) return {};
  std::string out(reinterpret_cast<const char*>(text), static_cast<std::size_t>(length));
  OPENSSL_free(text);
  return out;
}

}  // namespace tribodyn::server
