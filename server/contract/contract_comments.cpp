#include "server/contract/contract_comments.h"

#include <google/protobuf/descriptor.pb.h>

#include <sstream>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "server/contract/embedded_contract.h"

namespace tribodyn::server {
namespace {

using google::protobuf::DescriptorProto;
using google::protobuf::EnumDescriptorProto;
using google::protobuf::FileDescriptorProto;
using google::protobuf::FileDescriptorSet;
using google::protobuf::ServiceDescriptorProto;

/// The place of an element in its file, as google.protobuf.SourceCodeInfo has it: numbers of fields
/// and indexes in turn.
using SourcePath = std::vector<int>;

SourcePath operator+(SourcePath path, std::pair<int, int> step) {
  path.push_back(step.first);
  path.push_back(step.second);
  return path;
}

/// A comment as a proto has it, without the blanks at the beginnings of its lines.
std::string tidied(const std::string& comment) {
  std::istringstream lines(comment);
  std::string out;
  bool is_new_paragraph = false;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin == std::string::npos) {
      is_new_paragraph = true;
      continue;
    }
    if (!out.empty()) out += is_new_paragraph ? "\n\n" : " ";
    is_new_paragraph = false;
    out += line.substr(begin);
  }
  return out;
}

/// Adds the comments of one file.
class CommentReader {
 public:
  CommentReader(const FileDescriptorProto& file, std::map<std::string, std::string>& out)
      : out_(out) {
    for (const auto& location : file.source_code_info().location()) {
      const std::string& text = location.has_leading_comments() ? location.leading_comments()
                                                                : location.trailing_comments();
      if (!text.empty())
        by_path_[SourcePath(location.path().begin(), location.path().end())] = text;
    }
    const std::string scope = file.package();
    for (int i = 0; i < file.message_type_size(); ++i) {
      read(file.message_type(i), scope, SourcePath() + std::pair(file.kMessageTypeFieldNumber, i));
    }
    for (int i = 0; i < file.enum_type_size(); ++i) {
      read(file.enum_type(i), scope, SourcePath() + std::pair(file.kEnumTypeFieldNumber, i));
    }
    for (int i = 0; i < file.service_size(); ++i) {
      read(file.service(i), scope, SourcePath() + std::pair(file.kServiceFieldNumber, i));
    }
  }

 private:
  void add(const std::string& name, const SourcePath& path) {
    const auto found = by_path_.find(path);
    if (found != by_path_.end()) out_[name] = tidied(found->second);
  }
  void read(const DescriptorProto& type, const std::string& scope, const SourcePath& path) {
    const std::string name = scope + "." + type.name();
    add(name, path);
    for (int i = 0; i < type.field_size(); ++i) {
      add(name + "." + type.field(i).name(), path + std::pair(type.kFieldFieldNumber, i));
    }
    for (int i = 0; i < type.nested_type_size(); ++i) {
      read(type.nested_type(i), name, path + std::pair(type.kNestedTypeFieldNumber, i));
    }
    for (int i = 0; i < type.enum_type_size(); ++i) {
      read(type.enum_type(i), name, path + std::pair(type.kEnumTypeFieldNumber, i));
    }
  }
  /// The full name of a value has the scope of its enum.
  void read(const EnumDescriptorProto& type, const std::string& scope, const SourcePath& path) {
    add(scope + "." + type.name(), path);
    for (int i = 0; i < type.value_size(); ++i) {
      add(scope + "." + type.value(i).name(), path + std::pair(type.kValueFieldNumber, i));
    }
  }
  void read(const ServiceDescriptorProto& type, const std::string& scope, const SourcePath& path) {
    const std::string name = scope + "." + type.name();
    add(name, path);
    for (int i = 0; i < type.method_size(); ++i) {
      add(name + "." + type.method(i).name(), path + std::pair(type.kMethodFieldNumber, i));
    }
  }

  std::map<std::string, std::string>& out_;
  std::map<SourcePath, std::string> by_path_;
};

}  // namespace

ContractComments::ContractComments() {
  FileDescriptorSet set;
  const std::string_view bytes = embedded_contract();
  if (!set.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    throw std::logic_error("the embedded descriptors of the contract cannot be read");
  }
  for (const FileDescriptorProto& file : set.file()) CommentReader(file, comments_);
}

std::string ContractComments::of(const std::string& full_name) const {
  const auto found = comments_.find(full_name);
  return found == comments_.end() ? std::string() : found->second;
}

}  // namespace tribodyn::server
