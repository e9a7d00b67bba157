#include "client/cpp/text/warnings.h"

#include <algorithm>
#include <cctype>

#include "client/cpp/text/output.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

template <class Warning>
ShownWarning shown(const Warning& warning, const std::string& message) {
  return {warning.code(), warning.summary().empty() ? warning.code() : warning.summary(),
          warning.level(), message};
}

std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string with_code(const std::string& sentence, const std::string& code) {
  return sentence + (sentence.ends_with('.') ? " [" : ". [") + code + "]";
}

bool has_warning(const v1::PointResult& result, const std::string& code) {
  return std::any_of(result.warnings().begin(), result.warnings().end(),
                     [&](const v1::RangeWarning& each) { return each.code() == code; });
}

}  // namespace

ShownWarning shown_warning(const v1::RangeWarning& warning) {
  return shown(warning, warning.message());
}
ShownWarning shown_warning(const v1::PointWarning& warning) {
  return shown(warning, warning.message());
}
ShownWarning shown_warning(const v1::CandidateWarning& warning) { return shown(warning, ""); }

std::string warning_sentence(const ShownWarning& warning) {
  std::string summary = warning.summary;
  const std::size_t colon = summary.rfind(": ");
  if (colon != std::string::npos &&
      warning.message.find(summary.substr(colon + 2)) != std::string::npos) {
    summary.erase(colon);  // the message says it too
  }
  std::string out = capitalised(summary);
  if (!warning.where.empty()) out += ", " + warning.where;
  if (!warning.message.empty()) out += ": " + warning.message;
  return with_code(out, warning.code);
}

std::string note_sentence(const ShownWarning& note) {
  return with_code((note.where.empty() ? "" : note.where + ": ") +
                       capitalised(note.message.empty() ? note.summary : note.message),
                   note.code);
}

WarningCollector::WarningCollector(std::vector<std::string> places, std::string unit,
                                   std::string all, std::vector<std::string> subjects)
    : places_(std::move(places)),
      unit_(std::move(unit)),
      all_(std::move(all)),
      subjects_(std::move(subjects)) {}

void WarningCollector::add(const ShownWarning& warning, std::size_t subject, std::size_t place) {
  const auto [known, is_new] = found_.try_emplace(warning.code);
  Found& found = known->second;
  if (is_new) {
    found.first = warning;
    const std::string at = text_of_places({place});
    std::vector<std::string> words;
    if (subjects_.size() > 1) words.push_back(subjects_[subject]);
    if (!at.empty()) words.push_back("at " + at);
    found.first_place = joined(words, " ");
  }
  found.first.level = std::max(found.first.level, warning.level);
  found.is_same_everywhere = found.is_same_everywhere && warning.message == found.first.message;
  found.places[subject].insert(place);
}

std::string WarningCollector::text_of_places(const std::set<std::size_t>& affected) const {
  if (affected.size() == places_.size() && affected.size() > 1) return all_;
  std::vector<std::string> runs;
  for (auto each = affected.begin(); each != affected.end();) {
    const std::size_t first = *each;
    std::size_t last = first;
    while (++each != affected.end() && *each == last + 1) last = *each;
    runs.push_back(first == last ? places_[first] : places_[first] + " to " + places_[last]);
  }
  if (runs.size() > 1) {
    runs[runs.size() - 2] += " and " + runs.back();
    runs.pop_back();
  }
  const std::string text = joined(runs, ", ");
  return text.empty() || unit_.empty() ? text : text + " " + unit_;
}

std::string WarningCollector::where(const Found& found) const {
  std::map<std::set<std::size_t>, std::vector<std::string>> groups;
  for (const auto& [subject, places] : found.places) groups[places].push_back(subjects_[subject]);
  std::vector<std::string> out;
  for (const auto& [places, names] : groups) {
    const std::string text = text_of_places(places);
    const std::string who = names.size() == subjects_.size() ? "" : joined(names, ", ");
    out.push_back(who + (text.empty() ? "" : (who.empty() ? "at " : " at ") + text));
  }
  return joined(out, "; ");
}

std::vector<ShownWarning> WarningCollector::warnings() const {
  std::vector<ShownWarning> out;
  for (const auto& [code, found] : found_) {
    ShownWarning& warning = out.emplace_back(found.first);
    warning.where = where(found);
    if (!found.is_same_everywhere && !found.first_place.empty()) {
      if (warning.message.ends_with('.')) warning.message.pop_back();
      warning.message += " (" + found.first_place + ")";
    }
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const ShownWarning& a, const ShownWarning& b) { return a.level > b.level; });
  return out;
}

void add_warnings(const std::vector<ShownWarning>& warnings, Sheet& sheet) {
  std::string last_heading;
  for (const ShownWarning& warning : warnings) {
    const std::string heading =
        is_outside_range(warning.level) ? "Outside the validated range" : "Method of computation";
    if (heading != last_heading) sheet.heading(heading);
    last_heading = heading;
    sheet.remark(warning_sentence(warning));
  }
}

std::string warnings_text(const std::vector<ShownWarning>& warnings) {
  Sheet sheet;
  add_warnings(warnings, sheet);
  return sheet.text();
}

std::string footer_text(const ShownWarning& warning, const std::string& start) {
  return (start.empty() ? capitalised(warning.summary) : start + warning.summary) +
         (warning.where.empty() ? "" : ", " + warning.where) + " [" + warning.code + "].";
}

std::string warnings_json(const std::vector<ShownWarning>& warnings) {
  std::vector<std::string> out;
  for (const ShownWarning& each : warnings) {
    out.push_back("{\"code\": " + json_quoted(each.code) +
                  ", \"level\": " + json_quoted(v1::WarningLevel_Name(each.level)) +
                  ", \"summary\": " + json_quoted(each.summary) + ", \"message\": " +
                  json_quoted(each.message) + ", \"where\": " + json_quoted(each.where) + "}");
  }
  return "[" + joined(out, ",\n  ") + "]";
}

std::string withheld_text(const std::string& summary) {
  return summary.empty() ? "withheld" : "withheld: " + summary;
}

std::vector<std::pair<double, double>> merged_bands(std::vector<std::pair<double, double>> spans) {
  std::sort(spans.begin(), spans.end());
  std::vector<std::pair<double, double>> bands;
  for (const auto& span : spans) {
    if (!bands.empty() && span.first <= bands.back().second) {
      bands.back().second = std::max(bands.back().second, span.second);
    } else {
      bands.push_back(span);
    }
  }
  return bands;
}

std::vector<std::pair<double, double>> bands_where(const std::vector<double>& x,
                                                   const std::vector<bool>& holds) {
  std::vector<std::pair<double, double>> spans;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!holds[i]) continue;
    const double before = i > 0 ? x[i - 1] : x[i], after = i + 1 < x.size() ? x[i + 1] : x[i];
    spans.emplace_back((before + x[i]) / 2, (x[i] + after) / 2);
  }
  return merged_bands(std::move(spans));
}

std::vector<std::pair<double, double>> bands_where(const std::map<double, bool>& holds_at_x) {
  std::vector<double> x;
  std::vector<bool> holds;
  for (const auto& [place, is_held] : holds_at_x) {
    x.push_back(place);
    holds.push_back(is_held);
  }
  return bands_where(x, holds);
}

std::vector<CurveWarning> curve_warnings(const std::vector<v1::Simulation>& simulations) {
  std::set<double> speeds;
  std::vector<std::string> names;  // a lubricant at several temperatures is one subject
  for (const v1::Simulation& simulation : simulations) {
    const std::string name = resource_id(simulation.lubricant());
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    for (const v1::CurvePoint& point : simulation.result().points()) {
      speeds.insert(point.speed_kilometres_per_hour());
    }
  }
  const bool is_curve = !simulations.empty() && simulations.front().has_inefficiency_curve();
  std::vector<std::string> places;
  for (const double speed : speeds) places.push_back(is_curve ? significant(speed) : "");
  WarningCollector collector(places, is_curve ? "km/h" : "", "all speeds", names);
  for (const v1::Simulation& simulation : simulations) {
    const auto subject = static_cast<std::size_t>(
        std::find(names.begin(), names.end(), resource_id(simulation.lubricant())) - names.begin());
    for (const v1::CurvePoint& point : simulation.result().points()) {
      const auto place = static_cast<std::size_t>(
          std::distance(speeds.begin(), speeds.find(point.speed_kilometres_per_hour())));
      collector.add(point.result().warnings(), subject, place);
    }
  }
  std::vector<CurveWarning> out;
  char mark = 'a';
  for (const ShownWarning& each : collector.warnings()) {
    CurveWarning& warning = out.emplace_back(CurveWarning{each, "", {}});
    warning.bands = speed_bands(simulations, [&each](const v1::PointResult& result) {
      return has_warning(result, each.code);
    });
    if (is_outside_range(each.level) && !withholds_verdict(each.level) && mark <= 'z') {
      warning.mark = std::string(1, mark++);
    }
  }
  return out;
}

void add_warnings(const v1::Simulation& simulation, Sheet& sheet) {
  const std::vector<CurveWarning> warnings = curve_warnings({simulation});
  add_warnings(std::vector<ShownWarning>(warnings.begin(), warnings.end()), sheet);
}

}  // namespace tribodyn::client
