#pragma once

#include <map>
#include <string>

namespace tribodyn::server {

/// The comments of the contract's protos, which the program holds beside their descriptors.
class ContractComments {
 public:
  ContractComments();

  /// Returns the comment of a message, field, enum, value, service or method by its full name, e.g.
  /// "tribodyn.v1.Lubricant.name"; "" if it has none. Lines of a paragraph are joined; an empty
  /// line separates paragraphs.
  std::string of(const std::string& full_name) const;

 private:
  std::map<std::string, std::string> comments_;
};

}  // namespace tribodyn::server
