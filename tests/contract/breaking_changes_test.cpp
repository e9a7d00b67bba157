#include "tests/contract/breaking_changes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/contract/parsed_contract.h"

namespace tribodyn {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr char kContract[] = R"(
  message M {
    double a = 1;
    oneof choice { string b = 2; }
    repeated .p.M c = 3;
  }
  enum E { E_UNSPECIFIED = 0; E_ON = 1; }
  service S { rpc Get(.p.M) returns (stream .p.M); }
)";

/// Returns what breaks when `before` in the contract is replaced by `now`.
std::vector<std::string> broken_by(const std::string& before, const std::string& now) {
  std::string changed = kContract;
  const std::size_t at = changed.find(before);
  EXPECT_NE(at, std::string::npos) << before;
  changed.replace(at, before.size(), now);
  return breaking_changes(parsed_contract(kContract), parsed_contract(changed));
}

TEST(BreakingChanges, AreNotAdditions) {
  EXPECT_THAT(broken_by("double a = 1;", "double a = 1; int32 new = 4;"), IsEmpty());
  EXPECT_THAT(broken_by("E_ON = 1;", "E_ON = 1; E_NEW = 2;"), IsEmpty());
  EXPECT_THAT(broken_by("service S {", "message N {} service S { rpc List(.p.N) returns (.p.N);"),
              IsEmpty());
}

TEST(BreakingChanges, AreWhatVanishesUnlessItsNumberAndNameAreReserved) {
  EXPECT_THAT(broken_by("double a = 1;", ""), ElementsAre("p.M #1 (a, TYPE_DOUBLE) vanished"));
  EXPECT_THAT(broken_by("double a = 1;", "reserved 1;"),
              ElementsAre("p.M #1 (a, TYPE_DOUBLE) vanished and its name is not reserved"));
  EXPECT_THAT(broken_by("double a = 1;", "reserved 1; reserved \"a\";"), IsEmpty());
  EXPECT_THAT(broken_by("E_ON = 1;", ""), ElementsAre("p.E #1 (E_ON) vanished"));
  EXPECT_THAT(broken_by("E_ON = 1;", "reserved 1; reserved \"E_ON\";"), IsEmpty());
  EXPECT_THAT(broken_by("rpc Get(.p.M) returns (stream .p.M);", ""),
              ElementsAre("p.S/Get (p.M -> stream p.M) vanished"));
  EXPECT_THAT(
      breaking_changes(parsed_contract("message M { reserved 1; reserved \"a\"; }"),
                       parsed_contract("message M { double a = 1; }")),
      ElementsAre("p.M #1 was \"reserved\" and is \"a, TYPE_DOUBLE\"", "p.M a (reserved) vanished"))
      << "a reserved number comes back";
}

TEST(BreakingChanges, AreAChangedNumberNameTypeCardinalityOneofOrSignature) {
  const auto a_is = [](const std::string& now) {
    return ElementsAre("p.M #1 was \"a, TYPE_DOUBLE\" and is \"" + now + "\"");
  };
  EXPECT_THAT(broken_by("double a = 1;", "double a = 7;"),
              ElementsAre("p.M #1 (a, TYPE_DOUBLE) vanished"));
  EXPECT_THAT(broken_by("double a", "double z"), a_is("z, TYPE_DOUBLE"));
  EXPECT_THAT(broken_by("double a", "float a"), a_is("a, TYPE_FLOAT"));
  EXPECT_THAT(broken_by("double a", "repeated double a"), a_is("a, repeated TYPE_DOUBLE"));
  EXPECT_THAT(broken_by("double a", "optional double a"), a_is("a, optional TYPE_DOUBLE"));
  EXPECT_THAT(broken_by("repeated .p.M c", "repeated .p.N c"),
              ElementsAre("p.M #3 was \"c, repeated p.M\" and is \"c, repeated p.N\""));
  EXPECT_THAT(
      broken_by("oneof choice { string b = 2; }", "string b = 2;"),
      ElementsAre("p.M #2 was \"b, TYPE_STRING in oneof choice\" and is \"b, TYPE_STRING\""));
  EXPECT_THAT(broken_by("E_ON", "E_OFF"), ElementsAre("p.E #1 was \"E_ON\" and is \"E_OFF\""));
  EXPECT_THAT(broken_by("stream ", ""),
              ElementsAre("p.S/Get was \"p.M -> stream p.M\" and is \"p.M -> p.M\""));
}

}  // namespace
}  // namespace tribodyn
