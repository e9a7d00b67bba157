#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tribodyn::client {

/// All errors in a command line, one sentence each.
using Complaints = std::vector<std::string>;

/// One flag or positional argument of a command: its help and the function that reads its texts.
struct Flag {
  std::string names;        ///< "--speed-kilometres-per-hour,--speed"; "name" for a positional
  std::string value_name;   ///< "KM/H", "NAME", "FILE"; empty for a switch
  std::string description;  ///< with allowed range and default
  std::string group;        ///< heading in the help
  bool is_switch = false;
  bool is_repeatable = false;
  /// Reads all texts given (never empty; {"true"} or {"false"} for a switch).
  std::function<void(const std::vector<std::string>&, Complaints&)> read = {};
  /// Another name of a flag that the help lists already.
  bool is_hidden = false;
  /// Field of the request that the flag sets; empty: the field of its first name.
  std::string field = {};
  std::string bare_unit = {};  ///< unit of a number without one
  // Row of the server's constraint table that the help shows; empty: none.
  std::string constraint_message = {};
  std::string constraint_field = {};
  // Completion of the value.
  std::vector<std::string> words = {};  ///< one of these
  std::string collection = {};          ///< a name of this collection, e.g. "gearSets"
  bool is_file() const { return value_name.rfind("FILE", 0) == 0; }

  bool is_positional() const { return names.front() != '-'; }
  std::string first_name() const { return names.substr(0, names.find(',')); }
  /// Returns e.g. "sump_temperature_celsius" for "--sump-temperature-celsius,--sump".
  std::string field_name() const;
};

/// The unit, allowed range and default of a number, for its help.
struct NumberText {
  std::string unit;           ///< "km/h", "-" for a pure number
  std::string range;          ///< range that the server checks, e.g. "0 to 250"
  std::string standard = "";  ///< default in words or digits; empty: the number is required
};

/// The flags of a command. Each passes the value that it read to its setter; after an error it does
/// not call the setter.
class FlagList {
 public:
  /// Sets the heading of the following flags in the help.
  void group(std::string heading) { group_ = std::move(heading); }

  /// Adds a quantity: a number in the unit of `text`, or with its own unit.
  void number(const std::string& names, const NumberText& text, const std::string& description,
              const std::function<void(double)>& set);
  /// Adds a list of quantities separated by commas; the flag may be repeated.
  Flag& numbers(const std::string& names, const NumberText& text, const std::string& description,
                const std::function<void(double)>& add);
  void whole_number(const std::string& names, const NumberText& text,
                    const std::string& description, const std::function<void(int)>& set);
  Flag& text(const std::string& names, const std::string& value_name,
             const std::string& description, const std::function<void(const std::string&)>& set);
  /// Adds a repeatable flag; each text may hold several values separated by commas.
  Flag& texts(const std::string& names, const std::string& value_name,
              const std::string& description, const std::function<void(const std::string&)>& add);
  /// Adds a choice of one of `words`; `set` receives its index.
  Flag& choice(const std::string& names, const std::vector<std::string>& words,
               const std::string& description, const std::function<void(int)>& set);
  /// Like texts(), for values among `words`; `add` returns false for any other value.
  Flag& choices(const std::string& names, const std::string& words, const std::string& description,
                const std::function<bool(const std::string&)>& add);
  void toggle(const std::string& names, const std::string& description,
              const std::function<void()>& set);
  /// Adds a switch that --name=false sets to false.
  void truth(const std::string& names, const std::string& description,
             const std::function<void(bool)>& set);

  /// Adds a flag without `read`. The caller sets it, and other members, at once: adding another
  /// flag invalidates the reference.
  Flag& raw(const std::string& names, const std::string& value_name,
            const std::string& description);

  const std::vector<Flag>& flags() const { return flags_; }

 private:
  void add(const std::string& names, const std::string& value_name, const std::string& description,
           const std::function<void(const std::string&, Complaints&)>& read);

  std::string group_ = "Options";
  std::vector<Flag> flags_;
};

/// Whether a flag of the list has the first name of `common`, in place of which the command has it.
bool replaces(const FlagList& own, const Flag& common);

/// Returns e.g. "--sump-temperature-celsius" for "simulation.sump_temperature_celsius": flags have
/// the names of the fields that they set.
std::string flag_of_field(const std::string& field_path);
}  // namespace tribodyn::client
