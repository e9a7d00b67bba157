#pragma once

#include <google/protobuf/message.h>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace tribodyn {

/// Changes messages at random into ones that can be parsed and that a careless or malicious client
/// may send: numbers at the ends of their ranges and beyond, names of missing resources, texts of
/// any length, fields left out, repeated and moved. Equal seeds make equal changes.
///
/// Debian 12 has no libprotobuf-mutator, which does the same.
class HostileMessages {
 public:
  explicit HostileMessages(std::uint64_t seed) : random_(seed) {}

  /// Changes one field of the message or of a message in it.
  void mutate(google::protobuf::Message& message);
  /// Replaces one field of `message` by that of `other`, which has the same type.
  void graft(const google::protobuf::Message& other, google::protobuf::Message& message);

 private:
  using Message = google::protobuf::Message;
  using Field = google::protobuf::FieldDescriptor;

  std::size_t draw(std::size_t count) { return random_() % count; }
  template <class Items>
  const auto& draw_from(const Items& items) {
    return items[draw(std::size(items))];
  }

  void mutate_field(Message& message, const Field& field);
  void mutate_list(Message& message, const Field& field);
  void add_element(Message& message, const Field& field);
  void set_element(Message& message, const Field& field, int index);
  void set_field(Message& message, const Field& field);
  double number(double present);
  std::int64_t integer();
  int enum_number(const Field& field);
  std::string text(const std::string& present);
  std::string filter();

  std::mt19937_64 random_;
  std::vector<std::string> words_;  // paths of all fields of the changed message
};

}  // namespace tribodyn
