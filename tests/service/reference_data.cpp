#include "tests/service/reference_data.h"

#include <google/protobuf/util/json_util.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tests/support/paths.h"

namespace tribodyn::server {

JsonValue load_reference(const std::string& name) {
  std::ifstream file(test_data_file(name));
  std::stringstream stream;
  stream << file.rdbuf();
  std::string text = stream.str();
  const std::string bare = ": Infinity";
  for (std::size_t i = text.find(bare); i != std::string::npos; i = text.find(bare, i)) {
    text.replace(i, bare.size(), ": null");
  }
  JsonValue value;
  const auto status = google::protobuf::util::JsonStringToMessage(text, &value);
  if (!status.ok()) throw std::runtime_error(name + ": " + status.ToString());
  return value;
}

const JsonValue& at(const JsonValue& value, const std::string& path) {
  const JsonValue* here = &value;
  std::stringstream parts(path);
  for (std::string part; std::getline(parts, part, '.');) {
    here = here->has_list_value() ? &here->list_value().values(std::stoi(part))
                                  : &here->struct_value().fields().at(part);
  }
  return *here;
}

double number(const JsonValue& value, const std::string& path) {
  return at(value, path).number_value();
}

std::vector<double> numbers(const JsonValue& list) {
  std::vector<double> out;
  for (const JsonValue& value : list.list_value().values()) out.push_back(value.number_value());
  return out;
}

}  // namespace tribodyn::server
