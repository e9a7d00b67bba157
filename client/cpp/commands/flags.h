#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tribodyn::client {

/// What is wrong with a command line, all of it: one sentence each.
using Complaints = std::vector<std::string>;

/// One flag or positional argument of a command: how help shows it, and how its texts are read.
struct Flag {
  std::string names;        ///< "--speed-kilometres-per-hour,--speed"; "name" for a positional
  std::string value_name;   ///< "KM/H", "NAME", "FILE"; empty for a switch
  std::string description;  ///< with allowed range and default
  std::string group;        ///< heading in the help
  bool is_switch = false;
  bool is_repeatable = false;
  /// Takes every text given (never empty; {"true"} for a switch).
  std::function<void(const std::vector<std::string>&, Complaints&)> read = {};
  /// Another spelling of a flag that the help shows already.
  bool is_hidden = false;
  /// Field of the request that it sets; empty: the one that its first name says.
  std::string field = {};
  std::string bare_unit = {};  ///< of a number that is given without one
  // Row of the server's constraint table, for the help; empty: none.
  std::string constraint_message = {};
  std::string constraint_field = {};
  // What completion offers for the value.
  std::vector<std::string> words = {};  ///< one of these
  std::string collection = {};          ///< the name of a resource, e.g. of "gearSets"
  bool is_file() const { return value_name.rfind("FILE", 0) == 0; }

  bool is_positional() const { return names.front() != '-'; }
  std::string first_name() const { return names.substr(0, names.find(',')); }
  /// "sump_temperature_celsius" of "--sump-temperature-celsius,--sump".
  std::string field_name() const;
};

/// How a number is described: unit, allowed range and default are always shown together.
struct NumberText {
  std::string unit;           ///< "km/h", "-" for a pure number
  std::string range;          ///< as the server checks it: "0 to 250"
  std::string standard = "";  ///< the default in words or digits; empty: must be given
};

/// Collects the flags of a command; each hands what it read to its setter, and nothing that it
/// could not read.
class FlagList {
 public:
  /// Following flags stand under this heading in the help.
  void group(std::string heading) { group_ = std::move(heading); }

  /// A quantity: a number in the unit of `text`, or one with a unit of its own.
  void number(const std::string& names, const NumberText& text, const std::string& description,
              const std::function<void(double)>& set);
  /// Several quantities by commas; the flag may be repeated.
  void numbers(const std::string& names, const NumberText& text, const std::string& description,
               const std::function<void(double)>& add);
  void whole_number(const std::string& names, const NumberText& text,
                    const std::string& description, const std::function<void(int)>& set);
  Flag& text(const std::string& names, const std::string& value_name,
             const std::string& description, const std::function<void(const std::string&)>& set);
  /// Repeatable; each text may also hold several values separated by commas.
  Flag& texts(const std::string& names, const std::string& value_name,
              const std::string& description, const std::function<void(const std::string&)>& add);
  /// One of `words`; `set` gets its index.
  void choice(const std::string& names, const std::vector<std::string>& words,
              const std::string& description, const std::function<void(int)>& set);
  /// As texts; `add` says whether it knows the word, one of `words`.
  Flag& choices(const std::string& names, const std::string& words, const std::string& description,
                const std::function<bool(const std::string&)>& add);
  void toggle(const std::string& names, const std::string& description,
              const std::function<void()>& set);

  /// A flag whose `read` and other members the caller sets at once; the reference does not outlive
  /// the next flag.
  Flag& raw(const std::string& names, const std::string& value_name,
            const std::string& description);

  const std::vector<Flag>& flags() const { return flags_; }

 private:
  void add(const std::string& names, const std::string& value_name, const std::string& description,
           const std::function<void(const std::string&, Complaints&)>& read);

  std::string group_ = "Options";
  std::vector<Flag> flags_;
};

/// "--sump-temperature-celsius" from "simulation.sump_temperature_celsius": flags are named after
/// the fields they set.
std::string flag_of_field(const std::string& field_path);
}  // namespace tribodyn::client
