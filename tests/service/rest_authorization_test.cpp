// Who may call what by REST: the cases of every transport (authorization_table.h).
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <string>
#include <utility>

#include "server/transport/http/rest_handler.h"
#include "tests/service/authorization_table.h"
#include "tests/service/rest_rendering.h"

namespace tribodyn::server {
namespace {

class RestAuthorization : public AuthorizationTable {
 protected:
  google::rpc::Status call(const Method& row, const google::protobuf::Message& request,
                           const std::string& secret) override {
    HttpRequest sent = rest_request(handler_.routes(), row, request);
    sent.headers["host"] = "localhost";
    if (!secret.empty()) sent.headers["authorization"] = "Bearer " + secret;
    sent.peer = "127.0.0.1";
    std::promise<HttpResponse> promise;
    handler_.handle(std::move(sent), std::make_shared<std::atomic<bool>>(false),
                    [&](HttpResponse response) { promise.set_value(std::move(response)); });
    const HttpResponse response = promise.get_future().get();
    if (response.stream != nullptr) response.stream->hang_up();
    if (response.status == 200) return {};
    return error_of_json(response.body);
  }

  RestHandler handler_{dispatcher_};
};

TEST_F(RestAuthorization, EveryMethodRefusesWhoeverHasNoValidTokenAndReadsNoRow) {
  refuses_whoever_has_no_valid_token();
}

TEST_F(RestAuthorization, EveryMethodRefusesATokenOfAnotherProjectAndReadsNoRow) {
  refuses_a_token_of_another_project();
}

TEST_F(RestAuthorization, EveryMethodRefusesATooSmallScopeAndReadsNoRow) {
  refuses_a_too_small_scope();
}

TEST_F(RestAuthorization, NoMethodRefusesATokenOfSufficientScopeForAllProjects) {
  admits_a_sufficient_token_for_all_projects();
}

}  // namespace
}  // namespace tribodyn::server
