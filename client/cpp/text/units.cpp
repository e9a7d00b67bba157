#include "client/cpp/text/units.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>
#include <vector>

namespace tribodyn::client {
namespace {

/// Unit words at the end of a field's name, with the symbol of the unit.
constexpr std::array<std::pair<std::string_view, std::string_view>, 37> kUnitWords = {{
    {"per_pascal", "1/Pa"},
    {"per_second", "1/s"},
    {"per_square_metre", "1/m2"},
    {"percent", "%"},
    {"square_millimetres_per_second", "mm2/s"},
    {"millipascal_seconds", "mPa s"},
    {"pascal_seconds", "Pa s"},
    {"pascals", "Pa"},
    {"kilograms_per_cubic_metre_kelvin", "kg/(m3 K)"},
    {"kilograms_per_cubic_metre", "kg/m3"},
    {"kilogram_square_metres", "kg m2"},
    {"kilograms", "kg"},
    {"watts_per_metre_kelvin", "W/(m K)"},
    {"joules_per_kilogram_kelvin", "J/(kg K)"},
    {"kelvin_per_watt", "K/W"},
    {"watts", "W"},
    {"joules", "J"},
    {"newton_metres_per_radian", "N m/rad"},
    {"newton_metre_seconds_per_radian", "N m s/rad"},
    {"newton_seconds_per_metre", "N s/m"},
    {"newtons_per_metre", "N/m"},
    {"newton_metres", "N m"},
    {"newtons", "N"},
    {"metres_per_second_squared", "m/s2"},
    {"metres_per_second", "m/s"},
    {"kilometres_per_hour", "km/h"},
    {"radians_per_second", "rad/s"},
    {"square_metres", "m2"},
    {"millimetres", "mm"},
    {"micrometres", "um"},
    {"nanometres", "nm"},
    {"metres", "m"},
    {"degrees", "deg"},
    {"radians", "rad"},
    {"celsius", "C"},
    {"kelvin", "K"},
    {"seconds", "s"},
}};

constexpr double kDegreesPerRadian = 57.295779513082323;  // 180 / pi

/// Kilogram, metre, second, kelvin, radian.
using Dimensions = std::array<int, 5>;

/// mantissa * 10^exponent SI units. Powers of ten are kept apart because they are exact.
struct Unit {
  double mantissa = 1;
  int exponent = 0;
  Dimensions dimensions{};
};

struct Atom {
  std::string_view symbol;
  double mantissa;
  int exponent;
  Dimensions dimensions;
};

constexpr std::array kAtoms = {
    Atom{"m", 1, 0, {0, 1, 0, 0, 0}},
    Atom{"g", 1, -3, {1, 0, 0, 0, 0}},
    Atom{"s", 1, 0, {0, 0, 1, 0, 0}},
    Atom{"K", 1, 0, {0, 0, 0, 1, 0}},
    Atom{"rad", 1, 0, {0, 0, 0, 0, 1}},
    Atom{"N", 1, 0, {1, 1, -2, 0, 0}},
    Atom{"Pa", 1, 0, {1, -1, -2, 0, 0}},
    Atom{"J", 1, 0, {1, 2, -2, 0, 0}},
    Atom{"W", 1, 0, {1, 2, -3, 0, 0}},
    Atom{"St", 1, -4, {0, 2, -1, 0, 0}},
    Atom{"P", 1, -1, {1, -1, -1, 0, 0}},
    Atom{"bar", 1, 5, {1, -1, -2, 0, 0}},
    Atom{"l", 1, -3, {0, 3, 0, 0, 0}},
    Atom{"L", 1, -3, {0, 3, 0, 0, 0}},
    Atom{"t", 1, 3, {1, 0, 0, 0, 0}},
    Atom{"h", 3600, 0, {0, 0, 1, 0, 0}},
    Atom{"min", 60, 0, {0, 0, 1, 0, 0}},
    Atom{"%", 1, -2, {}},
    Atom{"1", 1, 0, {}},
    Atom{"deg", 0.017453292519943295, 0, {0, 0, 0, 0, 1}},
    Atom{"degrees", 0.017453292519943295, 0, {0, 0, 0, 0, 1}},
    Atom{"rpm", 0.10471975511965977, 0, {0, 0, -1, 0, 1}},
};

constexpr std::array<std::pair<char, int>, 9> kPrefixes = {{{'G', 9},
                                                            {'M', 6},
                                                            {'k', 3},
                                                            {'d', -1},
                                                            {'c', -2},
                                                            {'m', -3},
                                                            {'u', -6},
                                                            {'n', -9},
                                                            {'p', -12}}};

std::optional<Unit> find_atom(std::string_view symbol) {
  for (const Atom& atom : kAtoms) {
    if (atom.symbol == symbol) return Unit{atom.mantissa, atom.exponent, atom.dimensions};
  }
  for (const auto& [prefix, exponent] : kPrefixes) {
    if (symbol.size() < 2 || symbol[0] != prefix) continue;
    for (const Atom& atom : kAtoms) {
      if (atom.symbol == symbol.substr(1)) {
        return Unit{atom.mantissa, atom.exponent + exponent, atom.dimensions};
      }
    }
  }
  return std::nullopt;
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// Replaces signs that keyboards and laboratory sheets write in several ways by one spelling.
std::string plain_signs(std::string_view text) {
  std::string plain(text);
  for (const auto& [from, to] :
       std::initializer_list<std::pair<const char*, const char*>>{{"\u00b2", "2"},
                                                                  {"\u00b3", "3"},
                                                                  {"\u207b", "-"},
                                                                  {"\u00b9", "1"},
                                                                  {"\u00b7", " "},
                                                                  {"\u22c5", " "},
                                                                  {"*", " "},
                                                                  {"^", ""},
                                                                  {"\u00b5", "u"},
                                                                  {"\u03bc", "u"},
                                                                  {"\u00b0", ""},
                                                                  {"\u00a0", " "}}) {
    plain = replaced(std::move(plain), from, to);
  }
  return plain;
}

/// Reads a product of powers; a slash inverts the factor or bracket that follows it.
class UnitReader {
 public:
  explicit UnitReader(std::string text) : text_(std::move(text)) {}

  std::optional<Unit> read() {
    Unit unit;
    if (!product(1, unit) || at_ != text_.size()) return std::nullopt;
    return unit;
  }

 private:
  void skip_blanks() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }

  bool product(int sign, Unit& unit) {
    int next = sign;
    for (skip_blanks(); at_ < text_.size() && text_[at_] != ')'; skip_blanks()) {
      if (text_[at_] == '/') {
        ++at_;
        next = -sign;
        continue;
      }
      if (!factor(next, unit)) return false;
      next = sign;
    }
    return true;
  }

  bool factor(int sign, Unit& unit) {
    if (text_[at_] == '(') {
      ++at_;
      if (++depth_ > kDeepestBracket || !product(sign, unit) || at_ == text_.size()) return false;
      ++at_;
      --depth_;
      return true;
    }
    const std::size_t start = at_;
    const auto in_symbol = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%';
    };
    while (at_ < text_.size() && in_symbol(text_[at_])) ++at_;
    if (at_ == start) {
      if (text_[at_] != '1') return false;
      ++at_;
      return true;
    }
    const auto atom = find_atom(std::string_view(text_).substr(start, at_ - start));
    if (!atom) return false;
    int power = 1;
    const auto [end, error] =
        std::from_chars(text_.data() + at_, text_.data() + text_.size(), power);
    if (error == std::errc()) at_ = static_cast<std::size_t>(end - text_.data());
    if (power < -kGreatestPower || power > kGreatestPower) return false;
    power *= sign;
    unit.mantissa *= std::pow(atom->mantissa, power);
    unit.exponent += atom->exponent * power;
    for (std::size_t i = 0; i < unit.dimensions.size(); ++i) {
      unit.dimensions[i] += atom->dimensions[i] * power;
    }
    return true;
  }

  // Limits far beyond any unit, for files with other text where a unit is expected.
  static constexpr int kDeepestBracket = 10;
  static constexpr int kGreatestPower = 99;

  std::string text_;
  std::size_t at_ = 0;
  int depth_ = 0;  // number of brackets that are open at `at_`
};

std::optional<Unit> parse_unit(std::string_view text) {
  // Data sheets write mPas, Nm and W/mK; W/mK never means a watt per millikelvin.
  std::string plain = plain_signs(text);
  for (const auto& [from, to] : {std::pair("Pas", "Pa s"), std::pair("Nm", "N m")}) {
    plain = replaced(std::move(plain), from, to);
  }
  if (plain.ends_with("W/mK")) plain.replace(plain.size() - 2, 2, "(m K)");
  return UnitReader(std::move(plain)).read();
}

bool is_celsius(std::string_view unit) {
  const std::string plain = plain_signs(unit);
  return plain == "C" || plain == "degC" || plain == "celsius" || plain == "Celsius";
}

bool is_fahrenheit(std::string_view unit) {
  const std::string plain = plain_signs(unit);
  return plain == "F" || plain == "degF";
}

/// Returns the number times 10^shift, with a single rounding.
std::optional<double> shifted(std::string_view number, int shift) {
  if (number.size() > 1 && number[0] == '+' && number[1] != '-') number.remove_prefix(1);
  const std::size_t mark = number.find_first_of("eE");
  if (mark != std::string_view::npos) {
    const std::string_view digits = number.substr(mark + 1);
    int own = 0;
    const char* first = digits.data() + (!digits.empty() && digits[0] == '+' ? 1 : 0);
    const auto [end, error] = std::from_chars(first, digits.data() + digits.size(), own);
    if (error != std::errc() || end != digits.data() + digits.size() || std::abs(own) > 400) {
      return std::nullopt;
    }
    shift += own;
  }
  const std::string text = std::string(number.substr(0, mark)) + "e" + std::to_string(shift);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

/// Returns the position at which the number ends and its unit begins.
std::size_t end_of_number(std::string_view text) {
  std::size_t at = 0;
  const auto digits = [&] {
    while (at < text.size() && ((text[at] >= '0' && text[at] <= '9') || text[at] == '.')) ++at;
  };
  if (at < text.size() && (text[at] == '-' || text[at] == '+')) ++at;
  digits();
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    std::size_t exponent = at + 1;
    if (exponent < text.size() && (text[exponent] == '-' || text[exponent] == '+')) ++exponent;
    if (exponent < text.size() && text[exponent] >= '0' && text[exponent] <= '9') {
      at = exponent;
      digits();
    }
  }
  return at;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// Returns the usual unit of data sheets for a number in `unit`.
std::string trade_unit(const std::string& unit) {
  if (unit == "1/Pa") return "1/GPa";
  if (unit == "Pa s") return "mPa s";
  if (unit == "Pa") return "MPa";
  if (unit == "1/m2") return "1/mm2";
  return unit;
}

/// Returns e.g. "20/GPa" or "40 C".
std::string with_unit(std::string_view number, std::string_view unit) {
  return std::string(number) + (unit.starts_with("1/") ? "" : " ") +
         std::string(unit.starts_with("1/") ? unit.substr(1) : unit);
}

/// The units that users write by mistake, by the unit in which the number should be.
const std::map<std::string, std::vector<const char*>>& mistaken_units() {
  static const std::map<std::string, std::vector<const char*>> kUnits = {
      {"kg/m3", {"g/cm3"}},
      {"mm2/s", {"m2/s"}},
      {"mPa s", {"Pa s"}},
      {"Pa s", {"mPa s"}},
      {"1/Pa", {"1/Pa", "1/GPa"}},
      {"Pa", {"Pa", "MPa", "GPa"}},
      {"kg", {"t", "g"}},
      {"m", {"m", "mm", "um"}},
      {"s", {"s", "us", "ns"}},
      {"K", {"K"}},
      {"C", {"K"}},
      {"km/h", {"m/s"}},
      {"rad/s", {"rpm"}},
      {"W/(m K)", {"mW/(m K)"}},
  };
  return kUnits;
}

/// Returns "73.3" for "73,3", a number with a decimal comma; empty for any other text.
std::string with_decimal_point(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos || comma == 0 || comma + 1 == text.size()) return "";
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (!is_digit(text[comma - 1]) || !is_digit(text[comma + 1])) return "";
  std::string changed(text);
  changed[comma] = '.';
  const std::string_view number = std::string_view(changed).substr(0, end_of_number(changed));
  const bool is_number = number.size() > comma && shifted(number, 0).has_value() &&
                         changed.find(',') == std::string::npos;
  return is_number ? changed : "";
}

/// Returns a temperature in Celsius, Fahrenheit or kelvin in `unit`, which is C or K.
std::optional<double> read_temperature(std::string_view number, std::string_view given,
                                       const std::string& unit) {
  auto value = shifted(number, 0);
  if (!value) return std::nullopt;
  if (is_fahrenheit(given)) {
    value = (*value - 32) / 1.8;
  } else if (!is_celsius(given)) {
    if (plain_signs(given) != "K") return std::nullopt;
    return is_celsius(unit) ? *value - kZeroCelsius : *value;
  }
  return is_celsius(unit) ? *value : *value + kZeroCelsius;
}

std::pair<std::string_view, std::string_view> split_field(std::string_view field) {
  field = field.substr(field.rfind('.') + 1);
  std::size_t longest = 0;
  std::string_view unit;
  for (const auto& [words, symbol] : kUnitWords) {
    if (words.size() <= longest || field.size() <= words.size() || !field.ends_with(words))
      continue;
    if (field[field.size() - words.size() - 1] != '_') continue;
    longest = words.size();
    unit = symbol;
  }
  return {longest == 0 ? field : field.substr(0, field.size() - longest - 1), unit};
}

bool ends_in_temperature(std::string_view name) {
  return name == "temperature" || name.ends_with("_temperature");
}

}  // namespace

std::string unit_of_field(std::string_view field) { return std::string(split_field(field).second); }

std::string label_of_field(std::string_view field) {
  std::string label(split_field(field).first);
  std::replace(label.begin(), label.end(), '_', ' ');
  return label;
}

bool is_temperature_field(std::string_view field) {
  const auto [name, unit] = split_field(field);
  return (unit == "K" || unit == "C") && ends_in_temperature(name);
}

std::optional<double> unit_ratio(std::string_view from, std::string_view to) {
  const auto source = parse_unit(from);
  const auto target = parse_unit(to);
  if (!source || !target || source->dimensions != target->dimensions) return std::nullopt;
  return source->mantissa / target->mantissa * std::pow(10, source->exponent - target->exponent);
}

std::optional<double> read_quantity(std::string_view text, const std::string& unit,
                                    const std::string& bare_unit, bool temperature,
                                    std::string& wrong) {
  text = trimmed(text);
  const std::size_t end = end_of_number(text);
  const std::string_view number = text.substr(0, end);
  const std::string_view own = trimmed(text.substr(end));
  if (const std::string meant = with_decimal_point(text); !meant.empty()) {
    wrong = "has a decimal comma; write a decimal point: " + meant;
    return std::nullopt;
  }
  if (!shifted(number, 0)) {
    wrong = "is not a number" + (unit.empty() ? "" : " in " + unit);
    return std::nullopt;
  }
  if (own.empty() && bare_unit.empty() && !unit.empty()) {
    wrong = "needs its unit, e.g. " + with_unit(number, temperature ? "C" : trade_unit(unit));
    return std::nullopt;
  }
  const std::string given = own.empty() ? bare_unit : std::string(own);
  if (temperature) {
    if (const auto value = read_temperature(number, given, unit)) return value;
    wrong = "is not a temperature in C, F or K";
    return std::nullopt;
  }
  if (given == unit) return shifted(number, 0);
  if (given == "%" && (unit == "degrees" || unit == "deg")) {
    return std::atan(shifted(number, -2).value_or(0)) * kDegreesPerRadian;
  }
  const auto source = parse_unit(given);
  const auto target = parse_unit(unit);
  if (!source || !target || source->dimensions != target->dimensions) {
    wrong = (unit.empty() ? std::string("must be a number without a unit")
                          : "must be in " + unit + " or a multiple of it");
    return std::nullopt;
  }
  const auto power = shifted(number, source->exponent - target->exponent);
  const double value = power.value_or(HUGE_VAL) * (source->mantissa / target->mantissa);
  if (std::isfinite(value)) return value;
  wrong = "is too large";
  return std::nullopt;
}

std::string unit_slip(std::string_view text, const std::string& unit, const std::string& bare_unit,
                      double low, double high) {
  const auto units = mistaken_units().find(unit);
  if (units == mistaken_units().end()) return "";
  text = trimmed(text);
  const std::string number(text.substr(0, end_of_number(text)));
  const std::string own(trimmed(text.substr(number.size())));
  const std::string given = own.empty() ? bare_unit : own;
  const bool temperature = is_celsius(unit) || unit == "K";
  std::string meant;
  for (const char* candidate : units->second) {
    std::string wrong;
    const auto value = read_quantity(number, unit, candidate, temperature, wrong);
    if (candidate == given || !value || *value < low || *value > high) continue;
    if (!meant.empty()) return "";  // two units fit: neither is likelier
    meant = candidate;
  }
  if (meant.empty()) return "";
  std::string cure = number + " looks like " + meant + ": write " + number +
                     (meant.starts_with("1/") ? meant.substr(1) : meant);
  std::string wrong;
  const auto in_bare_unit = read_quantity(number, bare_unit, meant, temperature, wrong);
  if (!bare_unit.empty() && in_bare_unit) {
    std::array<char, 64> plain;
    std::snprintf(plain.data(), plain.size(), "%.6g", *in_bare_unit);
    cure += std::string(" or ") + plain.data();
  }
  return cure;
}

std::string trade_unit_of_field(std::string_view field) {
  const std::string unit = unit_of_field(field);
  if (unit == "K" && is_temperature_field(field) && !field.starts_with("vogel")) return "C";
  if (field == "relaxation_time_seconds") return "us";
  if (field == "youngs_modulus_pascals") return "GPa";
  if (field == "glass_viscosity_pascal_seconds") return "Pa s";
  for (const char* small_length :
       {"asperity_radius_metres", "composite_rms_height_metres", "half_backlash_metres"}) {
    if (field == small_length) return "um";
  }
  return trade_unit(unit);
}

double in_trade_unit(std::string_view field, double value) {
  const std::string unit = trade_unit_of_field(field);
  if (unit == "C" && unit_of_field(field) == "K") return value - kZeroCelsius;
  return difference_in_trade_unit(field, value);
}

double difference_in_trade_unit(std::string_view field, double difference) {
  return difference * unit_ratio(unit_of_field(field), trade_unit_of_field(field)).value_or(1);
}

}  // namespace tribodyn::client
