#include "client/cpp/paper/figure.h"

#include <algorithm>
#include <cstdlib>

#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

/// Returns the number of a figure; the conclusions have the largest.
int order_of(const PaperFigure& figure) {
  const int number = std::atoi(figure.name.c_str());
  return number == 0 ? 1000 : number;
}

}  // namespace

const std::vector<PaperFigure>& paper_figures() {
  static const std::vector<PaperFigure> figures = [] {
    std::vector<PaperFigure> out;
    for (const auto& part : {rig_figures(), dynamics_figures(), inefficiency_figures()}) {
      out.insert(out.end(), part.begin(), part.end());
    }
    std::sort(out.begin(), out.end(), [](const PaperFigure& one, const PaperFigure& other) {
      return order_of(one) < order_of(other);
    });
    return out;
  }();
  return figures;
}

PaperCurve wide_sweep(bool is_down_sweep, const std::string& gear_set) {
  PaperCurve out;
  out.is_down_sweep = is_down_sweep;
  out.gear_set = gear_set;
  out.speeds = paper_speeds(170);
  return out;
}

double rms_inefficiency(const v1::PointResult& result) { return result.inefficiency_rms_percent(); }
double energy_inefficiency(const v1::PointResult& result) {
  return result.inefficiency_energy_mean_percent();
}
double mean_friction_torque(const v1::PointResult& result) {
  return -result.pinion_friction_torque_newton_metres().mean();
}

void add_evidence(const std::string& quantity, const std::string& unit, const PaperLine& line,
                  const std::vector<double>& places, const std::string& place_unit,
                  std::vector<Evidence>& out) {
  for (const double place : places) {
    out.push_back({quantity, unit, significant(place) + " " + place_unit, line.at(place)});
  }
}

Series paper_series(const PaperLine& line, std::size_t index, const std::string& label,
                    bool is_second) {
  const Look look = look_of(index);
  Series out;
  out.label = label;
  out.colour = look.colour;
  out.dashes = is_second ? look.side_dashes : look.dashes;
  out.width = is_second ? 1.6 : 2.4;
  out.x = line.x;
  out.y = line.y;
  return out;
}

Panel paper_panel(const std::string& title, const std::string& x_title) {
  Panel out;
  out.title = title;
  out.x_title = x_title;
  out.shows_samples = true;
  return out;
}

}  // namespace tribodyn::client
