#include "client/cpp/plot/footer.h"

#include <algorithm>
#include <set>
#include <utility>

#include "client/cpp/text/inputs.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr char kHatchedStart[] = "Hatched: ";
constexpr double kFooterSize = 11.5;
constexpr int kLongestLabel =
    20;  // characters; longer labels do not fit beside the frame of a curve
constexpr int kLongestNote = 30;
constexpr std::size_t kShownHash = 12;  // hexadecimal digits, of 64

/// Returns the first characters of a text and an ellipsis in place of the rest.
std::string elided(const std::string& text, int longest) {
  if (display_width(text) <= longest) return text;
  std::size_t end = 0;
  for (int shown = 0; end < text.size(); ++end) {
    const bool starts_a_character = (static_cast<unsigned char>(text[end]) & 0xC0U) != 0x80U;
    if (starts_a_character && ++shown == longest) break;
  }
  std::string start = text.substr(0, end);
  start.erase(start.find_last_not_of(' ') + 1);
  return start + "\xE2\x80\xA6";
}

/// Returns the warnings about fluids and the surface. A warning names its fluids only if it does
/// not concern all of them.
std::vector<std::string> input_texts(const std::vector<v1::Simulation>& simulations) {
  std::vector<std::string> lubricants;
  for (const v1::Simulation& each : simulations) {
    // Curves of one lubricant at several temperatures stand together.
    const std::string id = resource_id(each.lubricant());
    if (std::find(lubricants.begin(), lubricants.end(), id) == lubricants.end()) {
      lubricants.push_back(id);
    }
  }
  WarningCollector collector({""}, "", "", lubricants);
  for (const v1::Simulation& each : simulations) {
    const auto subject =
        std::find(lubricants.begin(), lubricants.end(), resource_id(each.lubricant()));
    collector.add(each.result().input_warnings(),
                  static_cast<std::size_t>(subject - lubricants.begin()), 0);
  }
  return warning_footers(collector.warnings());
}

/// Returns "Model version V; hash of inputs 1: 0123456789ab, 2: ..."
std::string identity_text(const std::vector<v1::Simulation>& simulations) {
  std::set<std::string> versions;
  std::vector<std::string> hashes;
  const Differences differences = differences_of(simulations);
  for (const v1::Simulation& simulation : simulations) {
    versions.insert(simulation.result().model_version());
    const std::string hash = simulation.result().input_hash().substr(0, kShownHash);
    const std::string apart = distinction(simulation, differences);
    hashes.push_back(simulations.size() == 1
                         ? hash
                         : resource_id(simulation.lubricant()) +
                               (apart.empty() ? "" : " (" + apart + ")") + ": " + hash);
  }
  return "Model version " + joined({versions.begin(), versions.end()}, ", ") + "; hash of inputs " +
         joined(hashes, ", ") + ".";
}

}  // namespace

std::vector<std::string> footer_texts(const std::vector<v1::Simulation>& simulations) {
  std::vector<std::string> texts;
  if (simulations.empty()) return texts;
  const bool is_curve = simulations.front().has_inefficiency_curve();
  for (const CurveWarning& warning : curve_warnings(simulations)) {
    texts.push_back(footer_text(warning, !is_curve               ? ""
                                         : !warning.mark.empty() ? "Strip " + warning.mark + ": "
                                         : withholds_verdict(warning.level) ? kHatchedStart
                                                                            : ""));
  }
  for (std::string& text : input_texts(simulations)) texts.push_back(std::move(text));
  texts.push_back(identity_text(simulations));
  return texts;
}

std::vector<std::string> warning_footers(const std::vector<ShownWarning>& warnings,
                                         bool is_hatched) {
  std::vector<std::string> out;
  for (const ShownWarning& each : warnings) {
    out.push_back(
        footer_text(each, is_hatched && withholds_verdict(each.level) ? kHatchedStart : ""));
  }
  return out;
}

std::vector<std::string> footer_lines(const std::vector<std::string>& texts, double width) {
  std::vector<std::string> lines;
  for (const std::string& text : texts) {
    for (std::string& line : text_lines(text, kFooterSize, width)) {
      lines.push_back(std::move(line));
    }
  }
  return lines;
}

void draw_footer(const std::vector<std::string>& lines, Point first, Svg& svg) {
  for (const std::string& line : lines) {
    svg.text(first, line, {kFooterSize, "start", "#555", false, 0});
    first.y += kFooterPitch;
  }
}

FluidTitle fluid_title(const std::string& lubricant, const std::string& title) {
  if (title.empty()) {
    const std::string id = resource_id(lubricant);
    const std::string whole = "lubricant " + id;
    return {display_width(whole) <= kLongestLabel ? whole : elided(id, kLongestLabel), ""};
  }
  const std::size_t colon = title.find(": ");
  const std::string note = colon == std::string::npos ? "" : title.substr(colon + 2);
  return {elided(title.substr(0, colon), kLongestLabel), elided(note, kLongestNote)};
}

}  // namespace tribodyn::client
