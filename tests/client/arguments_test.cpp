#include "client/cpp/commands/arguments.h"

#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "client/cpp/commands/help.h"
#include "client/cpp/commands/scenario.h"

namespace tribodyn::client {
namespace {

/// Parses with fresh commands; keeps what a test looks at.
struct Outcome {
  std::string path;
  Complaints complaints;
  bool wants_help;
  CommonOptions options;

  explicit Outcome(const std::vector<std::string>& arguments) {
    FlagList common_flags;
    add_common_flags(common_flags, options);
    const std::vector<Command> commands = all_commands();
    const Parsed parsed = parse_arguments(arguments, commands, common_flags);
    if (parsed.command != nullptr) path = parsed.command->path;
    complaints = parsed.complaints;
    wants_help = parsed.wants_help;
  }

  bool complains_of(const std::string& part) const {
    return std::any_of(complaints.begin(), complaints.end(), [&](const std::string& complaint) {
      return complaint.find(part) != std::string::npos;
    });
  }
};

TEST(Arguments, AcceptAWholePoint) {
  const Outcome outcome({"point", "--lubricant", "1", "--speed", "72.5", "--ascent-angle-degrees",
                         "-3", "--isothermal", "--as-published", "eq17,eq20", "-o", "json"});
  EXPECT_EQ(outcome.path, "point");
  EXPECT_TRUE(outcome.complaints.empty()) << outcome.complaints.front();
  EXPECT_EQ(outcome.options.output_format, OutputFormat::kJson);
}

TEST(Arguments, ComplainOfEverythingAtOnce) {
  const Outcome outcome({"point", "--speed", "fast", "--sump", "1e999", "--as-published", "eq99",
                         "--model", "quick", "--pinion-torque-newton-metres", "3", "--lubricnt",
                         "1", "--maximum-mesh-cycles", "2.5"});
  EXPECT_EQ(outcome.complaints.size(), 8U);
  for (const char* part :
       {"'fast' is not a number in km/h", "'1e999'", "'eq99'", "'quick'", "needs --pinion-speed",
        "is --lubricant meant?", "'2.5'", "--lubricant is missing"}) {
    EXPECT_TRUE(outcome.complains_of(part)) << part;
  }
}

TEST(Arguments, RefuseContradictions) {
  EXPECT_TRUE(Outcome({"point", "-l", "1", "--speed", "3", "--torque", "3", "--pinion-speed", "3"})
                  .complains_of("not both"));
  EXPECT_TRUE(Outcome({"point", "-l", "1,2", "--speed", "3"}).complains_of("one only"));
  EXPECT_TRUE(
      Outcome({"point", "-l", "1", "--speed", "3", "--speed", "4"}).complains_of("2 times"));
  EXPECT_TRUE(Outcome({"point", "-l", "1", "--speed"}).complains_of("--speed-kilometers-per-hour"));
  EXPECT_TRUE(Outcome({"jobs", "cancel"}).complains_of("NAME is missing"));
  EXPECT_TRUE(Outcome({"lubricants", "lst"}).complains_of("is lubricants list meant?"));
  EXPECT_TRUE(Outcome({"lubricants", "list", "more"}).complains_of("unknown argument more"));
}

TEST(Arguments, TakeSeveralLubricantsAndJobs) {
  EXPECT_TRUE(Outcome({"curve", "-l", "1", "--lubricant", "2,3"}).complaints.empty());
  EXPECT_TRUE(Outcome({"jobs", "watch", "a", "b"}).complaints.empty());
  EXPECT_TRUE(Outcome({"jobs", "get", "a", "b"}).complains_of("unknown argument b"));
}

TEST(Arguments, HelpOfACommand) {
  const Outcome outcome({"jobs", "list", "--help"});
  EXPECT_TRUE(outcome.wants_help);
  EXPECT_EQ(outcome.path, "jobs list");
}

TEST(Help, EveryNumberHasARangeAndEveryCommandAnExample) {
  for (const Command& command : all_commands()) {
    ASSERT_FALSE(command.examples.empty()) << command.path;
    EXPECT_EQ(command.examples.front().rfind("tribodyn " + command.path, 0), 0U);
    const std::string help = help_text(command, {}, nullptr);
    EXPECT_NE(help.find(command.examples.front()), std::string::npos);
    for (const Flag& flag : command.flags.flags()) {
      EXPECT_FALSE(flag.description.empty()) << flag.names;
      EXPECT_EQ(flag.description.find("Legal:  "), std::string::npos) << flag.names;
    }
  }
}

TEST(Help, ExamplesParse) {
  for (const Command& command : all_commands()) {
    for (const std::string& example : command.examples) {
      std::vector<std::string> words;
      for (std::size_t at = 0; at < example.size();) {
        const std::size_t end = std::min(example.find(' ', at), example.size());
        words.push_back(example.substr(at, end - at));
        at = end + 1;
      }
      words.erase(words.begin());
      const Outcome outcome(words);
      EXPECT_EQ(outcome.path, command.path);
      EXPECT_TRUE(outcome.complaints.empty()) << example << ": " << outcome.complaints.front();
    }
  }
}

TEST(ModelFlags, CoverEveryFieldOfModelOptions) {
  v1::ModelOptions options;
  FlagList list;
  add_model_flags(list, options);
  Complaints complaints;
  for (const Flag& flag : list.flags()) {
    EXPECT_NE(flag.description, "See ModelOptions.") << flag.names;
    if (flag.is_switch) flag.read({"true"}, complaints);
    if (flag.names == "--pressure-viscosity-index") flag.read({"houpert"}, complaints);
    if (flag.names == "--as-published") {
      flag.read({"eq17,eq20,eq22", "eq31", "eq43,eq46"}, complaints);
    }
  }
  EXPECT_TRUE(complaints.empty());
  const auto every_field_set = [](const google::protobuf::Message& message) {
    const auto* descriptor = message.GetDescriptor();
    for (int i = 0; i < descriptor->field_count(); ++i) {
      EXPECT_TRUE(message.GetReflection()->HasField(message, descriptor->field(i)))
          << descriptor->field(i)->full_name();
    }
  };
  every_field_set(options);
  every_field_set(options.as_published());
}

TEST(Numbers, AreReadWholeOrNotAtAll) {
  EXPECT_EQ(parse_number("-1.5e-3"), -1.5e-3);
  EXPECT_EQ(parse_number("+4"), 4);
  for (const char* text : {"", "1,5", "1 ", "nan", "inf", "0x10", "+-3", "1e999"}) {
    EXPECT_FALSE(parse_number(text)) << text;
  }
}

}  // namespace
}  // namespace tribodyn::client
