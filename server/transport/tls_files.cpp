#include "server/transport/tls_files.h"

#include <openssl/pem.h>
#include <openssl/x509.h>

#include <cstdio>
#include <memory>

namespace tribodyn::server {
namespace {

struct Closer {
  void operator()(std::FILE* file) const { std::fclose(file); }
  void operator()(X509* certificate) const { X509_free(certificate); }
  void operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
};
using File = std::unique_ptr<std::FILE, Closer>;
using Certificate = std::unique_ptr<X509, Closer>;
using Key = std::unique_ptr<EVP_PKEY, Closer>;

File open_pem(const std::string& path) {
  File file(std::fopen(path.c_str(), "re"));
  if (!file) throw ListenError("the TLS file " + path + " cannot be read");
  return file;
}

Certificate read_certificate(const std::string& path) {
  Certificate out(PEM_read_X509(open_pem(path).get(), nullptr, nullptr, nullptr));
  if (!out) throw ListenError("the TLS file " + path + " holds no certificate in PEM form");
  return out;
}

/// An encrypted key counts as unreadable: nobody is there to type its password.
Key read_key(const std::string& path) {
  const auto no_password = [](char*, int, int, void*) { return -1; };
  Key out(PEM_read_PrivateKey(open_pem(path).get(), nullptr, no_password, nullptr));
  if (!out) {
    throw ListenError("the TLS file " + path + " holds no unencrypted private key in PEM form");
  }
  return out;
}

}  // namespace

void require_usable(const TlsFiles& files) {
  const Certificate certificate = read_certificate(files.certificate);
  const Key key = read_key(files.key);
  if (X509_check_private_key(certificate.get(), key.get()) != 1) {
    throw ListenError("the key " + files.key + " is not that of the certificate " +
                      files.certificate);
  }
  if (X509_cmp_current_time(X509_get0_notAfter(certificate.get())) < 0) {
    throw ListenError("the certificate " + files.certificate + " has expired");
  }
  if (!files.client_authorities.empty()) read_certificate(files.client_authorities);
}

void require_tls(const ListenAddress& address, const TlsFiles& tls) {
  if (!address.is_remote() || tls.is_set()) return;
  throw ListenError("refusing to listen on \"" + to_text(address) +
                    "\" without TLS, as other machines may reach it: set --tls-certificate and "
                    "--tls-key (deploy/make-certificates makes them), or use 127.0.0.1:PORT, "
                    "[::1]:PORT or unix:PATH");
}

}  // namespace tribodyn::server
