#include "client/cpp/commands/campaign_command.h"

namespace tribodyn::client {
namespace {

constexpr char kDescription[] =
    "The campaign, e.g. 12 or campaigns/12 (`tribodyn campaigns list`).";

Command named_command(const CampaignTexts& texts) {
  Command command{texts.path, texts.summary, texts.about, {texts.example}, {}, {}, {}};
  command.flags.group("Arguments");
  return command;
}

void complain_of_missing(bool is_missing, Complaints& complaints) {
  if (!is_missing) return;
  complaints.emplace_back("NAME is missing; `tribodyn campaigns list` shows the campaigns");
}

}  // namespace

Command one_campaign_command(const CampaignTexts& texts, std::string& name) {
  Command command = named_command(texts);
  command.flags
      .text("name", "NAME", kDescription,
            [&name](const std::string& text) { name = resource_name("campaigns", text); })
      .collection = "campaigns";
  command.check = [&name](Complaints& complaints) {
    complain_of_missing(name.empty(), complaints);
  };
  return command;
}

Command campaigns_command(const CampaignTexts& texts, std::vector<std::string>& names) {
  Command command = named_command(texts);
  command.flags
      .texts(
          "name", "NAME", kDescription,
          [&names](const std::string& text) { names.push_back(resource_name("campaigns", text)); })
      .collection = "campaigns";
  command.check = [&names](Complaints& complaints) {
    complain_of_missing(names.empty(), complaints);
  };
  return command;
}

void add_check(Command& command, const std::function<void(Complaints&)>& check) {
  command.check = [first = command.check, check](Complaints& complaints) {
    if (first) first(complaints);
    check(complaints);
  };
}

}  // namespace tribodyn::client
