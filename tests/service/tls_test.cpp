// TLS beyond loopback: protocols, certificates of both sides, and certificates that are renewed
// while the server runs. The server listens on all addresses, and the tests connect through
// loopback.
#include <gmock/gmock.h>
#include <grpcpp/create_channel.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

#include "tests/service/grpc_fixture.h"
#include "tribodyn/v1/lubricants.grpc.pb.h"

namespace tribodyn::server {
namespace {

using grpc::StatusCode;
using testing::AllOf;
using testing::ContainsRegex;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

/// Returns what a shell command prints.
std::string output_of(const std::string& command) {
  std::string out;
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return out;
  for (int next = std::fgetc(pipe); next != EOF; next = std::fgetc(pipe)) {
    out += static_cast<char>(next);
  }
  pclose(pipe);
  return out;
}

std::string text_of(const std::string& path) {
  std::stringstream out;
  out << std::ifstream(path).rdbuf();
  return out.str();
}

class TlsTest : public GrpcTest {
 protected:
  void SetUp() override {
    make("certificates localhost 127.0.0.1");
    listen_ = "0.0.0.0:0";
    more_flags_ = {
        "--tls-certificate", file("server.pem"),      "--tls-key",           file("server.key"),
        "--http-listen",     "127.0.0.1:0,0.0.0.0:0", "--heartbeat-seconds", "0.2"};
    start();
  }
  void make(const std::string& arguments) const {
    const std::string program = make_certificates_program() + " ";
    EXPECT_EQ(output_of(program + folder_.file("") + arguments), "");
  }
  std::string file(const std::string& name, const std::string& of = "certificates") const {
    return folder_.file(of + "/" + name);
  }
  std::string port() const { return address_.substr(address_.rfind(':') + 1); }
  /// Of REST by TLS, since the last start.
  std::string rest_port() const { return text_after("REST at https://0.0.0.0:"); }
  std::string plain_rest_port() const { return text_after("REST at http://127.0.0.1:"); }
  /// The rest of the line in the log; "0" if there is none.
  std::string text_after(const std::string& words) const {
    const std::string log = process_->log();
    const std::size_t begin = log.rfind(words);
    if (begin == std::string::npos) return "0";
    return log.substr(begin + words.size(), log.find('\n', begin) - begin - words.size());
  }
  /// What curl prints for a path of REST: the answer and, at the end, its status.
  std::string curl(const std::string& path, const std::string& flags, const std::string& token,
                   const std::string& of = "certificates") const {
    const std::string header =
        token.empty() ? std::string(" ") : " -H 'Authorization: Bearer " + token + "' ";
    return output_of("curl -sSg --max-time 20 -w '%{http_code}' --cacert " + file("ca.pem", of) +
                     header + flags + " 'https://127.0.0.1:" + rest_port() + path + "'");
  }
  std::string tokens(const std::string& words) const {
    return output_of(server_program() + " tokens " + words + " --database " +
                     folder_.file("tribodyn.db"));
  }

  /// The status of a call over TLS with the certificates of a folder; `client` names that of the
  /// client.
  grpc::Status get(const std::string& token, const std::string& client = "",
                   const std::string& of = "certificates",
                   const std::string& client_of = "certificates") const {
    grpc::SslCredentialsOptions options;
    options.pem_root_certs = text_of(file("ca.pem", of));
    if (!client.empty()) {
      options.pem_cert_chain = text_of(file(client + ".pem", client_of));
      options.pem_private_key = text_of(file(client + ".key", client_of));
    }
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    // A number, as Debian's c-ares loses some bytes for each name that it looks up.
    const auto stub = v1::LubricantService::NewStub(
        grpc::CreateCustomChannel("127.0.0.1:" + port(), grpc::SslCredentials(options), arguments));
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(10));
    if (!token.empty()) context.AddMetadata("authorization", "Bearer " + token);
    v1::GetLubricantRequest request;
    request.set_name("lubricants/paper-fluid-1");
    v1::Lubricant answer;
    return stub->GetLubricant(&context, request, &answer);
  }
  std::string handshake(const std::string& flags, const std::string& port) const {
    return output_of("openssl s_client -connect 127.0.0.1:" + port + " -alpn h2 -CAfile " +
                     file("ca.pem") + " " + flags + " </dev/null");
  }
};

TEST_F(TlsTest, ACallNeedsTheServersAuthorityAndAToken) {
  EXPECT_TRUE(get(owner_token()).ok()) << get(owner_token()).error_message();
  EXPECT_EQ(get("").error_code(), StatusCode::UNAUTHENTICATED);
  make("others localhost");
  EXPECT_EQ(get(owner_token(), "", "others").error_code(), StatusCode::UNAVAILABLE)
      << "the client trusts another authority";
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(10));
  v1::Lubricant answer;
  const auto plain = v1::LubricantService::NewStub(connect("127.0.0.1:" + port()));
  EXPECT_EQ(plain->GetLubricant(&context, {}, &answer).error_code(), StatusCode::UNAVAILABLE)
      << "nothing is served in the clear";
}

TEST_F(TlsTest, ProtocolsBeforeTls12AndWeakCiphersAreRefused) {
  for (const std::string& served : {port(), rest_port()}) {
    for (const char* protocol : {"-tls1_2", "-tls1_3"}) {
      const std::string answer = handshake(protocol, served);
      EXPECT_THAT(answer, HasSubstr("Verify return code: 0 (ok)")) << protocol;
      EXPECT_THAT(answer, Not(HasSubstr("Cipher is (NONE)"))) << protocol;
    }
    for (const char* flags :
         {"-tls1 -cipher DEFAULT@SECLEVEL=0", "-tls1_1 -cipher DEFAULT@SECLEVEL=0",
          "-tls1_2 -cipher NULL,EXPORT,RC4,3DES:@SECLEVEL=0"}) {
      const std::string answer = handshake(flags, served);
      EXPECT_THAT(answer, HasSubstr("Cipher is (NONE)")) << flags;
      // The client has said hello, and the server has refused it: gRPC hangs up, REST says why.
      EXPECT_THAT(answer, ContainsRegex("has read [07] bytes and written 1")) << flags;
    }
  }
}

TEST_F(TlsTest, AClientsCertificateStandsForItsTokenAndIsRevokedLikeOne) {
  process_->signal(SIGTERM);
  ASSERT_EQ(process_->wait(), 0);
  make("certificates --client anna");
  make("certificates --client bert");
  make("others --client anna");
  more_flags_.insert(more_flags_.end(), {"--tls-client-authorities", file("ca.pem")});
  start();
  const std::string path = "/v1/lubricants/paper-fluid-1";
  const std::string as_anna = "--cert " + file("anna.pem") + " --key " + file("anna.key");
  EXPECT_EQ(get("", "anna").error_code(), StatusCode::UNAUTHENTICATED) << "nobody granted anything";
  EXPECT_EQ(tokens("create anna --certificate --scope read"), "");
  EXPECT_TRUE(get("", "anna").ok());
  EXPECT_THAT(curl(path, as_anna, ""), EndsWith("200"));
  EXPECT_EQ(get("", "bert").error_code(), StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(get("certificate:anna", "bert").error_code(), StatusCode::UNAUTHENTICATED);
  EXPECT_TRUE(get(owner_token(), "bert").ok()) << "a token says more than a certificate";
  EXPECT_EQ(get(owner_token()).error_code(), StatusCode::UNAVAILABLE) << "without a certificate";
  EXPECT_EQ(get("", "anna", "certificates", "others").error_code(), StatusCode::UNAVAILABLE)
      << "of another authority";
  EXPECT_THAT(curl(path, "", owner_token()), EndsWith("000")) << "REST without a certificate";
  EXPECT_THAT(
      curl(path, "--cert " + file("anna.pem", "others") + " --key " + file("anna.key", "others"),
           owner_token()),
      EndsWith("000"));
  tokens("revoke anna");
  EXPECT_THAT(curl(path, as_anna, ""), EndsWith("401"));
  EXPECT_EQ(get("", "anna").error_code(), StatusCode::UNAUTHENTICATED);
  EXPECT_THAT(tokens("create anna --certificate"), HasSubstr("another name"));
}

TEST_F(TlsTest, RestNeedsTheServersAuthorityAndAToken) {
  const std::string path = "/v1/lubricants/paper-fluid-1";
  EXPECT_THAT(curl(path, "", owner_token()),
              AllOf(HasSubstr("\"lubricants/paper-fluid-1\""), EndsWith("200")));
  EXPECT_THAT(curl(path, "--compressed", owner_token()), EndsWith("200"));
  EXPECT_THAT(curl(path, "", ""), AllOf(HasSubstr("UNAUTHENTICATED"), EndsWith("401")));
  make("others localhost 127.0.0.1");
  EXPECT_THAT(curl(path, "", owner_token(), "others"), HasSubstr("certificate"));
  EXPECT_THAT(output_of("curl -s --max-time 20 -w '%{http_code}' http://127.0.0.1:" + rest_port() +
                        "/healthz"),
              EndsWith("000"))
      << "nothing is served in the clear";
  EXPECT_THAT(curl(path, "-H 'Origin: https://evil.example'", owner_token()),
              AllOf(HasSubstr("FOREIGN_ORIGIN"), EndsWith("403")));
  EXPECT_THAT(
      curl(path, "--connect-to localhost::127.0.0.1: -H 'Host: axles.example.com'", owner_token()),
      EndsWith("200"))
      << "the certificate says what the server is called";
  const std::string twice = " 'https://127.0.0.1:" + rest_port() + path + "'";
  EXPECT_THAT(curl(path, "-o /dev/null -w '%{num_connects} '" + twice, owner_token()),
              HasSubstr("0 "))
      << "a connection carries more than one request";
}

TEST_F(TlsTest, ALongAnswerAndALongRequestPassThroughTlsWhole) {
  const std::string token = owner_token();
  const std::string body = folder_.file("body");
  std::ofstream(body) << R"({"display_name": ")" << std::string(900'000, 'x') << "\"}";
  EXPECT_THAT(curl("/v1/lubricants?lubricant_id=long",
                   "-H 'Content-Type: application/json' --data-binary @" + body, token),
              AllOf(HasSubstr("display_name"), EndsWith("400")))
      << "read to its end and refused for what it says";
  const std::string plain = output_of("curl -s --max-time 20 -H 'Authorization: Bearer " + token +
                                      "' http://127.0.0.1:" + plain_rest_port() + "/v1/gearSets");
  EXPECT_GT(plain.size(), 50'000U);
  EXPECT_EQ(curl("/v1/gearSets", "", token), plain + "200");
}

TEST_F(TlsTest, ARevokedTokenEndsItsRestStreamsByTlsWhenTheCommandReturns) {
  const std::string secret = tokens("create laptop --scope read");
  const std::string said = folder_.file("said");
  std::string status;
  std::thread stream([&] {
    status = curl("/v1/simulations:watch?filter=lubricant%20=%20%22paper-fluid-1%22",
                  "-N -o " + said, secret.substr(0, secret.find('\n')));
  });
  EXPECT_TRUE(eventually([&] { return !text_of(said).empty(); }));
  const auto before = std::chrono::steady_clock::now();
  tokens("revoke laptop");
  stream.join();
  EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(5));
  EXPECT_THAT(text_of(said), HasSubstr("UNAUTHENTICATED"));
  EXPECT_EQ(status, "200");
  EXPECT_THAT(curl("/v1/lubricants/paper-fluid-1", "", secret.substr(0, secret.find('\n'))),
              EndsWith("401"));
}

TEST_F(TlsTest, RestServesRenewedCertificatesAndNoRequestIsLostMeanwhile) {
  const auto serial = [&] {
    const std::string answer = handshake("-showcerts", rest_port());
    const std::size_t begin = answer.find("-----BEGIN CERTIFICATE-----");
    return answer.substr(begin, answer.find("-----END", begin) - begin);
  };
  const std::string former = serial();
  const std::string token = owner_token();
  std::atomic<bool> is_over = false;
  std::thread client([&] {
    while (!is_over) {
      EXPECT_THAT(curl("/v1/lubricants/paper-fluid-1", "", token), EndsWith("200"));
    }
  });
  for (int i = 0; i < 3; ++i) make("certificates localhost 127.0.0.1");
  EXPECT_TRUE(eventually([&] { return serial() != former; }));
  std::ofstream(file("server.pem")) << "half a file";
  std::this_thread::sleep_for(std::chrono::milliseconds(2500));
  is_over = true;
  client.join();
  EXPECT_THAT(process_->log(), HasSubstr("tls_files_not_read"));
}

TEST_F(TlsTest, RenewedCertificatesAreServedAndNoCallIsLostMeanwhile) {
  const auto serial = [&] {
    const std::string answer = handshake("-showcerts", port());
    const std::size_t begin = answer.find("-----BEGIN CERTIFICATE-----");
    return answer.substr(begin, answer.find("-----END", begin) - begin);
  };
  const std::string former = serial();
  const std::string token = owner_token();
  std::atomic<bool> is_over = false;
  std::atomic<int> calls = 0, failures = 0;
  std::vector<std::thread> clients;
  for (int i = 0; i < 2; ++i) {
    clients.emplace_back([&] {
      while (!is_over) {  // each over a connection of its own
        const grpc::Status status = get(token);
        if (!status.ok()) {
          ++failures;
          ADD_FAILURE() << status.error_message();
        }
        ++calls;
      }
    });
  }
  for (int i = 0; i < 3; ++i) make("certificates localhost 127.0.0.1");
  EXPECT_TRUE(eventually([&] { return serial() != former; }));
  const int before = calls;
  EXPECT_TRUE(eventually([&] { return calls > before + 5; }));
  is_over = true;
  for (std::thread& each : clients) each.join();
  EXPECT_EQ(failures, 0) << "of " << calls;
}

TEST(Tls, AnAddressOfRestBeyondLoopbackIsRefusedWithoutTls) {
  const TemporaryFolder folder;
  ServerProcess process(
      {"--listen", "127.0.0.1:0", "--http-listen", "0.0.0.0:0", "--database", folder.file("db")},
      folder.file("log"));
  EXPECT_EQ(process.wait(), 4);
  EXPECT_THAT(process.log(), HasSubstr("set --tls-certificate and --tls-key"));
  EXPECT_FALSE(std::filesystem::exists(folder.file("db"))) << "refused before anything is made";
}

TEST(Tls, AnAddressBeyondLoopbackIsRefusedWithoutUsableFiles) {
  const TemporaryFolder folder;
  const auto log_of = [&folder](std::vector<std::string> more) {
    more.insert(more.end(), {"--listen", "0.0.0.0:0", "--database", folder.file("db")});
    ServerProcess process(more, folder.file("log"));
    EXPECT_EQ(process.wait(), 4);
    std::string out = process.log();
    std::filesystem::remove(folder.file("log"));
    return out;
  };
  EXPECT_THAT(log_of({}), HasSubstr("set --tls-certificate and --tls-key"));
  const std::string program = make_certificates_program() + " ";
  ASSERT_EQ(output_of(program + folder.file("one") + " localhost"), "");
  ASSERT_EQ(output_of(program + folder.file("two") + " localhost"), "");
  EXPECT_THAT(log_of({"--tls-certificate", folder.file("one/server.pem"), "--tls-key",
                      folder.file("two/server.key")}),
              HasSubstr("is not that of the certificate"));
  EXPECT_THAT(log_of({"--tls-certificate", folder.file("none"), "--tls-key",
                      folder.file("two/server.key")}),
              HasSubstr("cannot be read"));
  EXPECT_THAT(log_of({"--tls-certificate", folder.file("one/server.key"), "--tls-key",
                      folder.file("one/server.key")}),
              HasSubstr("holds no certificate"));
  EXPECT_FALSE(std::filesystem::exists(folder.file("db"))) << "refused before anything is made";
}

}  // namespace
}  // namespace tribodyn::server
