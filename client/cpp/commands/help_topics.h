#pragma once

#include <string>
#include <vector>

namespace tribodyn::client {

/// A page of `tribodyn help`.
struct HelpTopic {
  std::string name;
  std::string summary;
  std::string text;
};

const std::vector<HelpTopic>& help_topics();

}  // namespace tribodyn::client
