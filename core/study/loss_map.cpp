#include "core/study/loss_map.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace tribodyn {
namespace {

constexpr int kTorque = 1;
/// First boxes in each coordinate: fine enough that no box hides the resonance of the mesh, whose
/// width is about a tenth of the speeds of a cycle.
constexpr std::array<int, 3> kFirstBoxes = {12, 3, 2};

}  // namespace

MapPlace LossMap::centre_of(const Box& box) {
  MapPlace out{};
  for (std::size_t d = 0; d < 3; ++d) out[d] = 0.5 * (box.low[d] + box.high[d]);
  return out;
}

std::vector<MapPlace> LossMap::corners_of(const Box& box) const {
  std::vector<MapPlace> out{box.low};
  for (std::size_t d = 0; d < 3; ++d) {
    if (!is_divided_[d]) continue;
    const std::size_t count = out.size();
    for (std::size_t i = 0; i < count; ++i) {
      MapPlace corner = out[i];
      corner[d] = box.high[d];
      out.push_back(corner);
    }
  }
  return out;
}

/// Returns where the model is solved for a box.
std::vector<MapPlace> LossMap::places_of(const Box& box,
                                         const std::vector<MapReading>& readings) const {
  std::vector<MapPlace> out;
  if (box.is_solved) {
    for (const std::size_t i : box.readings) out.push_back(readings[i].place);
    return out;
  }
  out = corners_of(box);
  const MapPlace centre = centre_of(box);
  out.push_back(centre);
  for (std::size_t d = 0; d < 3; ++d) {
    for (const double side : {box.low[d], box.high[d]}) {
      MapPlace face = centre;
      face[d] = side;
      out.push_back(face);
    }
  }
  return out;
}

void LossMap::evaluate(std::vector<Box>& boxes, const std::vector<MapReading>& readings,
                       const LossForces& loss_forces) {
  std::set<MapPlace> wanted;
  for (Box& box : boxes) {
    std::set<MapPlace> distinct;
    for (const std::size_t i : box.readings) distinct.insert(readings[i].place);
    // Beside what it shares with neighbours, a box takes about as many places as it has corners.
    // Readings of hardly any torque take long, because the flanks part, and lose hardly anything.
    const bool is_at_no_torque = box.low[kTorque] == 0 || box.high[kTorque] == 0;
    box.is_solved = !is_at_no_torque && distinct.size() <= corners_of(box).size();
    for (const MapPlace& place : places_of(box, readings)) wanted.insert(place);
  }
  std::vector<MapPlace> places;
  for (const MapPlace& place : wanted) {
    if (forces_.count(place) > 0) continue;
    if (place[kTorque] == 0) {
      forces_[place] = 0;
    } else {
      places.push_back(place);
    }
  }
  const std::vector<double> forces = places.empty() ? std::vector<double>() : loss_forces(places);
  for (std::size_t i = 0; i < places.size(); ++i) forces_[places[i]] = forces[i];
}

void LossMap::set_terms(Box& box) const {
  if (box.is_solved) return;
  const MapPlace centre = centre_of(box);
  for (std::size_t d = 0; d < 3; ++d) {
    MapPlace low = centre, high = centre;
    low[d] = box.low[d];
    high[d] = box.high[d];
    box.terms[d] = is_divided_[d]
                       ? std::abs(forces_.at(centre) - 0.5 * (forces_.at(low) + forces_.at(high)))
                       : 0;
  }
}

double LossMap::interpolated(const Box& box, const MapPlace& place) const {
  double out = 0;
  for (const MapPlace& corner : corners_of(box)) {
    double weight = 1;
    for (std::size_t d = 0; d < 3; ++d) {
      if (!is_divided_[d]) continue;
      const double share = (place[d] - box.low[d]) / (box.high[d] - box.low[d]);
      weight *= corner[d] == box.high[d] ? share : 1 - share;
    }
    out += weight * forces_.at(corner);
  }
  return out;
}

void LossMap::sum(const std::vector<Box>& boxes, const std::vector<MapReading>& readings) {
  energy_ = error_ = 0;
  for (const Box& box : boxes) {
    for (const std::size_t i : box.readings) {
      values_[i] =
          box.is_solved ? forces_.at(readings[i].place) : interpolated(box, readings[i].place);
      energy_ += values_[i] * readings[i].distance;
      error_ += box.error() * readings[i].distance;
    }
  }
}

LossMap::LossMap(const std::vector<MapReading>& readings, const LossForces& loss_forces,
                 const LossMapOptions& options)
    : values_(readings.size(), 0) {
  if (readings.empty()) return;
  MapPlace low = readings.front().place, high = low;
  for (const MapReading& reading : readings) {
    for (std::size_t d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], reading.place[d]);
      high[d] = std::max(high[d], reading.place[d]);
    }
  }
  // Cuts of each coordinate.
  std::array<std::vector<double>, 3> cuts;
  for (std::size_t d = 0; d < 3; ++d) {
    std::vector<double> ends{low[d], high[d]};
    if (d == kTorque && low[d] < 0 && high[d] > 0) ends = {low[d], 0, high[d]};
    is_divided_[d] = low[d] < high[d];
    cuts[d].push_back(low[d]);
    for (std::size_t k = 0; k + 1 < ends.size() && is_divided_[d]; ++k) {
      for (int i = 1; i <= kFirstBoxes[d]; ++i) {
        const double share = static_cast<double>(i) / kFirstBoxes[d];
        cuts[d].push_back(i == kFirstBoxes[d] ? ends[k + 1]
                                              : ends[k] + share * (ends[k + 1] - ends[k]));
      }
    }
  }
  const auto box_number = [&](std::size_t d, double value) {
    if (!is_divided_[d]) return std::size_t{0};
    const auto above = std::upper_bound(cuts[d].begin() + 1, cuts[d].end() - 1, value);
    return static_cast<std::size_t>(above - cuts[d].begin()) - 1;
  };
  std::map<std::array<std::size_t, 3>, Box> first;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    std::array<std::size_t, 3> number{};
    Box box{};
    for (std::size_t d = 0; d < 3; ++d) {
      number[d] = box_number(d, readings[i].place[d]);
      box.low[d] = cuts[d][number[d]];
      box.high[d] = is_divided_[d] ? cuts[d][number[d] + 1] : box.low[d];
    }
    first.try_emplace(number, box).first->second.readings.push_back(i);
  }
  std::vector<Box> boxes;
  for (auto& [number, box] : first) boxes.push_back(std::move(box));
  std::vector<Box> fresh = std::move(boxes);
  boxes.clear();
  while (true) {
    evaluate(fresh, readings, loss_forces);
    for (Box& box : fresh) {
      set_terms(box);
      boxes.push_back(std::move(box));
    }
    fresh.clear();
    sum(boxes, readings);
    const double wanted = options.tolerance * std::abs(energy_);
    if (!(error_ > wanted) || points() >= options.most_points) return;  // also if NaN
    // Halves the boxes with the largest errors until the others' errors add up to half of `wanted`.
    const auto contribution = [&](const Box& box) {
      double distance = 0;
      for (const std::size_t i : box.readings) distance += readings[i].distance;
      return box.error() * distance;
    };
    std::sort(boxes.begin(), boxes.end(), [&](const Box& one, const Box& other) {
      return contribution(one) > contribution(other);
    });
    double left = error_;
    std::size_t halved = 0;
    while (halved < boxes.size() && left > 0.5 * wanted) left -= contribution(boxes[halved++]);
    for (std::size_t k = 0; k < halved; ++k) {
      const Box& box = boxes[k];
      const std::size_t d = static_cast<std::size_t>(
          std::max_element(box.terms.begin(), box.terms.end()) - box.terms.begin());
      const double middle = centre_of(box)[d];
      Box below{box.low, box.high, {}}, above{box.low, box.high, {}};
      below.high[d] = above.low[d] = middle;
      for (const std::size_t i : box.readings) {
        (readings[i].place[d] < middle ? below : above).readings.push_back(i);
      }
      for (Box* half : {&below, &above}) {
        if (!half->readings.empty()) fresh.push_back(std::move(*half));
      }
    }
    boxes.erase(boxes.begin(), boxes.begin() + static_cast<std::ptrdiff_t>(halved));
  }
}

}  // namespace tribodyn
