#include "client/cpp/text/flags.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

/// Returns e.g. "Oil bath temperature. Allowed: -70 to 200 C. Default: 40 C."
std::string described(const std::string& description, const NumberText& text) {
  const std::string unit = text.unit == "-" ? "" : " " + text.unit;
  return description + ". Allowed: " + text.range + unit +
         (text.standard.empty() ? "." : ". Default: " + text.standard + unit + ".");
}

std::string quoted(const std::string& text) { return "'" + printable(text) + "'"; }

std::string complaint(const std::string& name, const std::string& given, const std::string& wrong) {
  return name + ": " + quoted(given) + " " + wrong;
}

std::string value_name_of(const NumberText& text) {
  return text.unit == "-" ? "NUMBER" : text.unit;
}

/// Returns a complaint if the value is 0 and the allowed range begins above 0; otherwise "".
/// A whole number that is 0 is not set for the server, which takes the default.
std::string complaint_of_zero(const NumberText& text, const std::string& description) {
  const bool has_meaning =
      text.standard.starts_with("0") || description.find("0: ") != std::string::npos;
  int lowest = 0;
  std::from_chars(text.range.data(), text.range.data() + text.range.size(), lowest);
  if (has_meaning || lowest <= 0) return "";
  return "is not within " + text.range + (text.unit == "-" ? "" : " " + text.unit);
}

}  // namespace

std::string flag_of_field(const std::string& field_path) {
  std::string flag = field_path.substr(field_path.rfind('.') + 1);
  flag = flag.substr(0, flag.find('['));
  std::replace(flag.begin(), flag.end(), '_', '-');
  return "--" + flag;
}

std::string Flag::field_name() const {
  if (!field.empty()) return field;
  std::string name = first_name().substr(std::min<std::size_t>(first_name().size(), 2));
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

void FlagList::add(const std::string& names, const std::string& value_name,
                   const std::string& description,
                   const std::function<void(const std::string&, Complaints&)>& read) {
  Flag flag{names, value_name, description, group_};
  flag.read = [name = flag.first_name(), read](const std::vector<std::string>& texts,
                                               Complaints& complaints) {
    if (texts.size() > 1) {
      complaints.push_back(name + " may be given only once");
    }
    for (const std::string& text : texts) read(text, complaints);
  };
  flags_.push_back(std::move(flag));
}

Flag& FlagList::raw(const std::string& names, const std::string& value_name,
                    const std::string& description) {
  flags_.push_back({names, value_name, description, group_});
  return flags_.back();
}

void FlagList::number(const std::string& names, const NumberText& text,
                      const std::string& description, const std::function<void(double)>& set) {
  const std::string name = names.substr(0, names.find(','));
  const std::string unit = text.unit == "-" ? "" : text.unit;
  add(names, value_name_of(text), described(description, text),
      [=](const std::string& given, Complaints& complaints) {
        std::string wrong;
        if (const auto value = read_quantity(given, unit, unit, unit == "C", wrong)) {
          set(*value);
        } else {
          complaints.push_back(complaint(name, given, wrong));
        }
      });
  flags_.back().bare_unit = unit;
}

Flag& FlagList::numbers(const std::string& names, const NumberText& text,
                        const std::string& description, const std::function<void(double)>& add) {
  const std::string unit = text.unit == "-" ? "" : text.unit;
  Flag flag{names, value_name_of(text), described(description, text), group_};
  flag.is_repeatable = true;
  flag.bare_unit = unit;
  flag.read = [name = flag.first_name(), unit, add](const std::vector<std::string>& texts,
                                                    Complaints& complaints) {
    for (const std::string& given : texts) {
      if (given.empty()) complaints.push_back(name + " is empty");
      for (const std::string& part : split(given, ',')) {
        std::string wrong;
        if (const auto value = read_quantity(part, unit, unit, unit == "C", wrong)) {
          add(*value);
        } else {
          complaints.push_back(complaint(name, part, wrong));
        }
      }
    }
  };
  flags_.push_back(std::move(flag));
  return flags_.back();
}

void FlagList::whole_number(const std::string& names, const NumberText& text,
                            const std::string& description, const std::function<void(int)>& set) {
  const std::string name = names.substr(0, names.find(','));
  add(names, value_name_of(text), described(description, text),
      [=, zero = complaint_of_zero(text, description)](const std::string& given,
                                                       Complaints& complaints) {
        int value = 0;
        const char* last = given.data() + given.size();
        const auto [end, error] = std::from_chars(given.data(), last, value);
        const bool is_whole = error == std::errc() && end == last;
        if (is_whole && (value != 0 || zero.empty())) {
          set(value);
        } else {
          complaints.push_back(complaint(name, given, is_whole ? zero : "is not a whole number"));
        }
      });
}

Flag& FlagList::text(const std::string& names, const std::string& value_name,
                     const std::string& description,
                     const std::function<void(const std::string&)>& set) {
  const std::string name = names.substr(0, names.find(','));
  add(names, value_name, description, [=](const std::string& given, Complaints& complaints) {
    if (given.empty()) complaints.push_back(name + " is empty");
    set(given);
  });
  return flags_.back();
}

Flag& FlagList::texts(const std::string& names, const std::string& value_name,
                      const std::string& description,
                      const std::function<void(const std::string&)>& add_value) {
  choices(names, value_name, description, [add_value](const std::string& value) {
    add_value(value);
    return true;
  });
  return flags_.back();
}

Flag& FlagList::choices(const std::string& names, const std::string& words,
                        const std::string& description,
                        const std::function<bool(const std::string&)>& add_value) {
  Flag flag{names, words, description, group_};
  flag.is_repeatable = true;
  flag.read = [name = flag.first_name(), words, add_value](const std::vector<std::string>& given,
                                                           Complaints& complaints) {
    for (const std::string& text : given) {
      if (text.empty()) complaints.push_back(name + " is empty");
      for (const std::string& value : split(text, ',')) {
        if (value.empty()) {
          complaints.push_back(complaint(name, text, "has an empty part"));
        } else if (!add_value(value)) {
          complaints.push_back(complaint(name, value, "must be one of " + words));
        }
      }
    }
  };
  flag.words = split(words, '|');
  if (flag.words.size() == 1) flag.words.clear();  // a single word is a placeholder such as NAMES
  flags_.push_back(std::move(flag));
  return flags_.back();
}

Flag& FlagList::choice(const std::string& names, const std::vector<std::string>& words,
                       const std::string& description, const std::function<void(int)>& set) {
  const std::string name = names.substr(0, names.find(','));
  std::string all;
  for (const std::string& word : words) {
    if (!all.empty()) all += '|';
    all += word;
  }
  add(names, all, description, [=](const std::string& given, Complaints& complaints) {
    const auto found = std::find(words.begin(), words.end(), given);
    if (found == words.end()) {
      complaints.push_back(complaint(name, given, "must be one of " + all));
    } else {
      set(static_cast<int>(found - words.begin()));
    }
  });
  flags_.back().words = words;
  return flags_.back();
}

void FlagList::toggle(const std::string& names, const std::string& description,
                      const std::function<void()>& set) {
  truth(names, description, [set](bool is_on) {
    if (is_on) set();
  });
}

void FlagList::truth(const std::string& names, const std::string& description,
                     const std::function<void(bool)>& set) {
  Flag flag{names, "", description, group_};
  flag.is_switch = true;
  flag.read = [set, name = flag.first_name()](const std::vector<std::string>& texts,
                                              Complaints& complaints) {
    if (texts.back() == "true" || texts.back() == "false") {
      set(texts.back() == "true");
    } else {
      complaints.push_back(complaint(name, texts.back(), "must be true or false"));
    }
  };
  flags_.push_back(std::move(flag));
}

bool replaces(const FlagList& own, const Flag& common) {
  return std::any_of(own.flags().begin(), own.flags().end(),
                     [&](const Flag& flag) { return flag.first_name() == common.first_name(); });
}

}  // namespace tribodyn::client
