#include "tests/support/hostile_message.h"

#include <google/protobuf/descriptor.h>

#include <array>
#include <cmath>
#include <limits>

namespace tribodyn {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

constexpr std::size_t kLongestList = 300;
constexpr std::size_t kMostMessages = 2000;  // candidates for a change
constexpr int kWordDepth = 4;  // of paths such as "requests.lubricant.provenance.field"
constexpr std::size_t kLongestText = 20'000;

constexpr std::array kNumbers = {0.0,
                                 -0.0,
                                 1.0,
                                 -1.0,
                                 1e-9,
                                 20.0,
                                 65.0,
                                 273.15,
                                 1e9,
                                 1e300,
                                 -1e300,
                                 std::numeric_limits<double>::max(),
                                 std::numeric_limits<double>::lowest(),
                                 std::numeric_limits<double>::min(),
                                 std::numeric_limits<double>::denorm_min(),
                                 std::numeric_limits<double>::epsilon(),
                                 std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::quiet_NaN()};

constexpr std::array<std::int64_t, 14> kIntegers = {
    0, 1, -1, 2, 64, 1000, 1001, 4096, 4097, 1 << 20, INT_MAX, INT_MIN, INT64_MAX, INT64_MIN};

const std::array<std::string, 34> kTexts = {
    "",
    "*",
    ".",
    "..",
    "/",
    "@",
    "lubricants/paper-fluid-1",
    "lubricants/paper-fluid-1@1",
    "lubricants/paper-fluid-1@0",
    "lubricants/paper-fluid-1@99999999999",
    "lubricants/",
    "lubricants/no-such",
    "gearSets/reference-axle",
    "gearSets/reference-axle@1",
    "surfaces/run-in",
    "vehicles/passenger-car",
    "simulations/1",
    "simulations/-1",
    "simulations/9223372036854775808",
    "name desc",
    "create_time asc",
    "provenance",
    "measurements.densities",
    "a.b.c.d.e.f.g",
    "' OR 1=1 --",
    "%s%n",
    "\n",
    std::string(1, '\0'),
    "\x1b[31m",
    "\u00e4\u00f6\u00fc",
    "\U0001f600",
    "\ufeff",
    "1e400",
    "NaN",
};

const std::array<std::string, 10> kOperators = {"=",  "!=", "<", "<=", ">",
                                                ">=", ":",  "",  "==", "~"};
const std::array<std::string, 14> kValues = {
    "1",    "1e308", "nan",  "-inf", "USED",         "*",     "2026-01-31T12:00:00Z",
    "\"\"", "\"",    "\"\\", "x",    "\"a \\\" b\"", "0x1p3", "99999-13-32T25:61:61Z"};
const std::array<std::string, 6> kJoints = {" AND ", " AND", " OR ", "  ", " AND AND ", "\tAND\n"};

void add_words(const Descriptor& descriptor, const std::string& prefix, int depth,
               std::vector<std::string>& words) {
  for (int i = 0; i < descriptor.field_count(); ++i) {
    const FieldDescriptor& field = *descriptor.field(i);
    words.push_back(field.name());
    words.push_back(prefix + field.name());
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE && depth > 1) {
      add_words(*field.message_type(), prefix + field.name() + ".", depth - 1, words);
    }
  }
}

/// Collects the message and all messages in it.
void collect(Message& message, std::vector<Message*>& messages) {
  if (messages.size() >= kMostMessages) return;
  messages.push_back(&message);
  const Reflection& reflection = *message.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    if (field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) continue;
    if (!field->is_repeated()) {
      collect(*reflection.MutableMessage(&message, field), messages);
      continue;
    }
    for (int i = 0; i < reflection.FieldSize(message, field); ++i) {
      collect(*reflection.MutableRepeatedMessage(&message, field, i), messages);
    }
  }
}

bool is_ascii(const std::string& text) {
  for (const char c : text) {
    if (static_cast<unsigned char>(c) >= 0x80) return false;
  }
  return true;
}

}  // namespace

void HostileMessages::mutate(Message& message) {
  words_.clear();
  add_words(*message.GetDescriptor(), "", kWordDepth, words_);
  std::vector<Message*> messages;
  collect(message, messages);
  Message& chosen = *draw_from(messages);
  const Descriptor& descriptor = *chosen.GetDescriptor();
  if (descriptor.field_count() == 0) return;
  mutate_field(chosen, *descriptor.field(static_cast<int>(
                           draw(static_cast<std::size_t>(descriptor.field_count())))));
}

void HostileMessages::graft(const Message& other, Message& message) {
  const Descriptor& descriptor = *message.GetDescriptor();
  if (descriptor.field_count() == 0 || other.GetDescriptor() != &descriptor) return;
  const Field& field =
      *descriptor.field(static_cast<int>(draw(static_cast<std::size_t>(descriptor.field_count()))));
  Message* const copy = other.New();
  copy->CopyFrom(other);
  message.GetReflection()->SwapFields(&message, copy, {&field});
  delete copy;
}

void HostileMessages::mutate_field(Message& message, const Field& field) {
  const Reflection& reflection = *message.GetReflection();
  if (field.is_repeated()) return mutate_list(message, field);
  if (draw(4) == 0) return reflection.ClearField(&message, &field);
  set_field(message, field);
}

void HostileMessages::mutate_list(Message& message, const Field& field) {
  const Reflection& reflection = *message.GetReflection();
  const int size = reflection.FieldSize(message, &field);
  const auto any = [&] { return static_cast<int>(draw(static_cast<std::size_t>(size))); };
  switch (size == 0 ? 0 : draw(6)) {
    case 0:
      return add_element(message, field);
    case 1:
      return reflection.RemoveLast(&message, &field);
    case 2:
      return reflection.SwapElements(&message, &field, any(), any());
    case 3:
      reflection.SwapElements(&message, &field, any(), size - 1);
      return reflection.RemoveLast(&message, &field);
    case 4: {
      // Adds many elements; if they are messages, copies the first one.
      for (std::size_t more = draw(kLongestList); more > 0; --more) {
        if (field.cpp_type() == Field::CPPTYPE_MESSAGE) {
          reflection.AddMessage(&message, &field)
              ->CopyFrom(reflection.GetRepeatedMessage(message, &field, 0));
        } else {
          add_element(message, field);
        }
      }
      return;
    }
    default:
      return set_element(message, field, any());
  }
}

void HostileMessages::add_element(Message& message, const Field& field) {
  const Reflection& reflection = *message.GetReflection();
  switch (field.cpp_type()) {
    case Field::CPPTYPE_MESSAGE:
      reflection.AddMessage(&message, &field);
      return;
    case Field::CPPTYPE_STRING:
      return reflection.AddString(&message, &field, text(""));
    case Field::CPPTYPE_DOUBLE:
      return reflection.AddDouble(&message, &field, number(0));
    case Field::CPPTYPE_INT32:
      return reflection.AddInt32(&message, &field, static_cast<std::int32_t>(integer()));
    case Field::CPPTYPE_INT64:
      return reflection.AddInt64(&message, &field, integer());
    case Field::CPPTYPE_ENUM:
      return reflection.AddEnumValue(&message, &field, enum_number(field));
    case Field::CPPTYPE_BOOL:
      return reflection.AddBool(&message, &field, draw(2) == 0);
    default:
      return;  // the contract has no other types
  }
}

void HostileMessages::set_element(Message& message, const Field& field, int index) {
  const Reflection& reflection = *message.GetReflection();
  switch (field.cpp_type()) {
    case Field::CPPTYPE_MESSAGE:
      return reflection.MutableRepeatedMessage(&message, &field, index)->Clear();
    case Field::CPPTYPE_STRING:
      return reflection.SetRepeatedString(
          &message, &field, index, text(reflection.GetRepeatedString(message, &field, index)));
    case Field::CPPTYPE_DOUBLE:
      return reflection.SetRepeatedDouble(
          &message, &field, index, number(reflection.GetRepeatedDouble(message, &field, index)));
    default:
      return add_element(message, field);
  }
}

void HostileMessages::set_field(Message& message, const Field& field) {
  const Reflection& reflection = *message.GetReflection();
  switch (field.cpp_type()) {
    case Field::CPPTYPE_MESSAGE:
      reflection.MutableMessage(&message, &field);
      return;
    case Field::CPPTYPE_STRING:
      return reflection.SetString(&message, &field, text(reflection.GetString(message, &field)));
    case Field::CPPTYPE_DOUBLE:
      return reflection.SetDouble(&message, &field, number(reflection.GetDouble(message, &field)));
    case Field::CPPTYPE_INT32:
      return reflection.SetInt32(&message, &field, static_cast<std::int32_t>(integer()));
    case Field::CPPTYPE_INT64:
      return reflection.SetInt64(&message, &field, integer());
    case Field::CPPTYPE_ENUM:
      return reflection.SetEnumValue(&message, &field, enum_number(field));
    case Field::CPPTYPE_BOOL:
      return reflection.SetBool(&message, &field, !reflection.GetBool(message, &field));
    default:
      return;
  }
}

double HostileMessages::number(double present) {
  switch (draw(5)) {
    case 0:
      return std::nextafter(present, draw(2) == 0 ? -HUGE_VAL : HUGE_VAL);
    case 1:
      return -present;
    case 2:
      return present * std::ldexp(1.0, static_cast<int>(draw(61)) - 30);
    case 3:
      return present * (0.5 + static_cast<double>(draw(1000)) / 1000);
    default:
      return draw_from(kNumbers);
  }
}

std::int64_t HostileMessages::integer() { return draw_from(kIntegers); }

int HostileMessages::enum_number(const Field& field) {
  const auto& type = *field.enum_type();
  const std::size_t place = draw(static_cast<std::size_t>(type.value_count()) + 2);
  if (place >= static_cast<std::size_t>(type.value_count())) {
    return draw(2) == 0 ? -1 : 12345;  // proto3 keeps unknown values
  }
  return type.value(static_cast<int>(place))->number();
}

std::string HostileMessages::text(const std::string& present) {
  switch (draw(8)) {
    case 0:
      return std::string(std::array<std::size_t, 8>{1, 63, 64, 65, 255, 1000, 2001, 5000}[draw(8)],
                         'x');
    case 1:
      return draw_from(words_);
    case 2:
      return draw_from(words_) + "." + draw_from(words_);
    case 3:
      return filter();
    case 4:
      return present.size() < kLongestText ? present + present : "";
    case 5:
      return present + draw_from(kTexts);
    case 6:
      return is_ascii(present) ? present.substr(0, draw(present.size() + 1)) : "";
    default:
      return draw_from(kTexts);
  }
}

std::string HostileMessages::filter() {
  static const std::array<std::string, 5> kFields = {"state", "labels.project", "create_time",
                                                     "condition", "labels."};
  std::string out;
  for (std::size_t count = 1 + draw(4); count > 0; --count) {
    out += draw(2) == 0 ? draw_from(kFields) : draw_from(words_);
    out += draw_from(kOperators);
    out += draw_from(kValues);
    if (count > 1) out += draw_from(kJoints);
  }
  return out;
}

}  // namespace tribodyn
