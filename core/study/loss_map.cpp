#include "core/study/loss_map.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/refusal.h"

namespace tribodyn {
namespace {

constexpr std::size_t kTorque = 1;
/// First boxes in each coordinate: fine enough that no box hides the resonance of the mesh, whose
/// width is about a tenth of the speeds of a cycle.
constexpr std::array<int, 3> kFirstBoxes = {12, 2, 1};
/// Over the error of linear interpolation: see loss_map.h.
constexpr double kErrorFactor = 0.5;
/// A map takes at least so many times the points of its first boxes: 2 to 3 for the NEDC, UDDS and
/// WLTC.
constexpr double kPointsOverFirst = 2;
/// Of the allowed error, for the boxes that are not divided at a time. Not critical: with 0.5 a
/// WLTC takes 6 % more points.
constexpr double kShareLeft = 0.8;
constexpr double kLightShare = 0.5;  // of the tolerance, for losses under light torques
/// Responses that may be missed before places near them count as missed too. Each takes as long as
/// 30 others. A WLTC has 10 to 20.
constexpr std::size_t kMostMissed = 50;
constexpr std::size_t kPlacesAtOnce = 16;  // between counts of the missed responses
constexpr std::size_t kMostThorough = 4;   // places of a map; each may take 0.3 s

/// The loss force at a place [N].
struct MapSample {
  double force = 0;
  double solver_error = 0;
  double doubt = 0;  // error, if the response was not found
};

/// Sums over readings [J].
struct MapSums {
  double energy = 0, interpolation_error = 0, doubt = 0, solver_error = 0;

  void add(const MapSample& sample, double distance) {
    energy += sample.force * distance;
    doubt += sample.doubt * distance;
    solver_error += sample.solver_error * distance;
  }
  void operator+=(const MapSums& other) {
    energy += other.energy;
    interpolation_error += other.interpolation_error;
    doubt += other.doubt;
    solver_error += other.solver_error;
  }
  double error() const { return interpolation_error + doubt; }
};

/// A box with the readings in it.
struct ReadBox : MapBox {
  std::vector<std::size_t> readings;
  bool is_solved = false;  // at its readings themselves
  MapPlace deviation{};    // of the forces [N]
  MapSums sums;
};

/// Joins the readings of each place; in ascending order of places.
std::vector<MapReading> distinct_readings(const std::vector<MapReading>& readings) {
  std::map<MapPlace, double> distances;
  for (const MapReading& each : readings) distances[each.place] += each.distance;
  std::vector<MapReading> out;
  for (const auto& [place, distance] : distances) out.push_back({place, distance});
  return out;
}

/// Returns the largest torque [N m] of which all lighter readings together, if each lost as much as
/// under it, would lose no more than a share of all losses. These count as proportional to torque.
double light_torque(const std::vector<MapReading>& readings, double share) {
  std::vector<std::pair<double, double>> distances;  // by magnitude of torque
  double all = 0;
  for (const MapReading& each : readings) {
    distances.emplace_back(std::abs(each.place[kTorque]), each.distance);
    all += distances.back().first * each.distance;
  }
  std::sort(distances.begin(), distances.end());
  double lighter = 0, out = 0;
  for (const auto& [torque, distance] : distances) {
    if (lighter * torque > share * all) break;
    out = torque;
    lighter += distance;
  }
  return out;
}

class Mapping {
 public:
  Mapping(const std::vector<MapReading>& readings, const LossForces& loss_forces,
          const LossMapOptions& options)
      : readings_(distinct_readings(readings)),
        loss_forces_(loss_forces),
        options_(options),
        light_torque_(light_torque(readings_, kLightShare * options.tolerance)) {
    whole_.low = whole_.high = readings_.front().place;
    for (const MapReading& reading : readings_) {
      for (std::size_t d = 0; d < 3; ++d) {
        whole_.low[d] = std::min(whole_.low[d], reading.place[d]);
        whole_.high[d] = std::max(whole_.high[d], reading.place[d]);
      }
    }
  }

  void run() {
    std::vector<ReadBox> first = first_boxes();
    const double first_points = static_cast<double>(places_of(first).size());
    if (options_.is_point_by_point ||
        static_cast<double>(readings_.size()) <= kPointsOverFirst * first_points) {
      light_torque_ = 0;
      ReadBox all;
      all.is_solved = true;
      for (std::size_t i = 0; i < readings_.size(); ++i) all.readings.push_back(i);
      first = {all};
    }
    add(std::move(first));
    refine();
    if (total().error() > wanted()) {
      search_doubtful_places();
      refine();
    }
  }

  /// Returns the losses at the readings from which this was made.
  MappedLoss losses(const std::vector<MapReading>& readings) const {
    std::map<MapPlace, double> forces;
    for (const ReadBox& box : boxes_) {
      const std::vector<Node> nodes = nodes_of(box);
      for (const std::size_t i : box.readings) {
        forces[readings_[i].place] = sample_at(box, nodes, readings_[i].place).force;
      }
    }
    MappedLoss out;
    for (const MapReading& each : readings) out.forces.push_back(forces.at(each.place));
    const MapSums sums = total();
    out.energy = sums.energy;
    out.map_error = sums.error();
    out.solver_error = sums.solver_error;
    out.points =
        static_cast<int>(std::count_if(samples_.begin(), samples_.end(),
                                       [](const auto& each) { return each.first[kTorque] != 0; }));
    return out;
  }

 private:
  struct Node {
    MapPlace place;
    const MapSample* sample;
  };

  MapSums total() const {
    MapSums out;
    for (const ReadBox& box : boxes_) out += box.sums;
    return out;
  }
  double wanted() const { return options_.tolerance * std::abs(total().energy); }

  std::vector<double> cuts_of(std::size_t d, double low, double high) const {
    std::vector<double> ends{low};
    if (d == kTorque) {
      for (const double end : {-light_torque_, 0.0, light_torque_}) {
        if (ends.back() < end && end < high) ends.push_back(end);
      }
    }
    ends.push_back(high);
    std::vector<double> out{low};
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
      const bool is_light =
          d == kTorque && std::max(std::abs(ends[k]), std::abs(ends[k + 1])) <= light_torque_;
      const int count = is_light ? 1 : kFirstBoxes[d];
      for (int i = 1; i < count; ++i) out.push_back(ends[k] + (ends[k + 1] - ends[k]) * i / count);
      out.push_back(ends[k + 1]);
    }
    return out;
  }

  std::vector<ReadBox> first_boxes() const {
    std::array<std::vector<double>, 3> cuts;
    for (std::size_t d = 0; d < 3; ++d) cuts[d] = cuts_of(d, whole_.low[d], whole_.high[d]);
    std::map<std::array<std::size_t, 3>, ReadBox> boxes;
    for (std::size_t i = 0; i < readings_.size(); ++i) {
      std::array<std::size_t, 3> number{};
      ReadBox box;
      static_cast<MapBox&>(box) = whole_;
      for (std::size_t d = 0; d < 3; ++d) {
        if (!whole_.has_width(d)) continue;
        const auto above =
            std::upper_bound(cuts[d].begin() + 1, cuts[d].end() - 1, readings_[i].place[d]);
        number[d] = static_cast<std::size_t>(above - cuts[d].begin()) - 1;
        box.low[d] = cuts[d][number[d]];
        box.high[d] = cuts[d][number[d] + 1];
      }
      boxes.try_emplace(number, std::move(box)).first->second.readings.push_back(i);
    }
    std::vector<ReadBox> out;
    for (auto& [number, box] : boxes) {
      box.is_solved = has_few_readings(box);
      out.push_back(std::move(box));
    }
    return out;
  }

  /// Beside what it shares with neighbours, a box has two nodes to the power of its dimensions.
  static bool has_few_readings(const ReadBox& box) {
    return box.readings.size() <= std::size_t{1} << box.dimensions();
  }

  /// Returns the places of the boxes that have no sample yet.
  std::set<MapPlace> places_of(const std::vector<ReadBox>& boxes) const {
    std::set<MapPlace> out;
    const auto add = [&](const MapPlace& place) {
      if (samples_.count(place) == 0) out.insert(place);
    };
    for (const ReadBox& box : boxes) {
      if (box.is_solved) {
        for (const std::size_t i : box.readings) add(readings_[i].place);
      } else {
        for (const MapPlace& place : box.nodes()) add(place);
      }
    }
    return out;
  }

  /// Whether a brief search may find the response.
  bool is_searched(const MapPlace& place) const {
    if (std::abs(place[kTorque]) < light_torque_) return false;
    if (missed_.size() <= kMostMissed) return true;
    double nearest = std::numeric_limits<double>::infinity();
    for (const MapPlace& each : missed_) nearest = std::min(nearest, distance(place, each));
    return std::any_of(found_.begin(), found_.end(),
                       [&](const MapPlace& each) { return distance(place, each) < nearest; });
  }

  /// Returns the square of the distance of two places, each coordinate over its range.
  double distance(const MapPlace& one, const MapPlace& other) const {
    double out = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      if (!whole_.has_width(d)) continue;
      const double off = (one[d] - other[d]) / (whole_.high[d] - whole_.low[d]);
      out += off * off;
    }
    return out;
  }

  void solve(const std::set<MapPlace>& places) {
    const LossEffort effort =
        options_.is_point_by_point ? LossEffort::kThorough : LossEffort::kBrief;
    std::vector<MapPlace> searched, others;
    const auto search = [&] {
      const std::vector<MapPlace> missed = set_found(searched, effort);
      for (auto* list : {&missed_, &others})
        list->insert(list->end(), missed.begin(), missed.end());
      searched.clear();
    };
    for (const MapPlace& place : places) {
      if (place[kTorque] == 0) {
        samples_[place] = {};
      } else if (is_searched(place)) {
        searched.push_back(place);
        if (searched.size() == kPlacesAtOnce) search();
      } else {
        others.push_back(place);
      }
    }
    search();
    set_found(others, LossEffort::kQuasiStatic);
  }

  /// Sets the samples of the places whose loss is found, and returns the others.
  std::vector<MapPlace> set_found(const std::vector<MapPlace>& places, LossEffort effort) {
    std::vector<MapPlace> out;
    if (places.empty()) return out;
    const std::vector<std::optional<LossForce>> forces = loss_forces_(places, effort);
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (!forces[i]) {
        out.push_back(places[i]);
      } else if (effort == LossEffort::kQuasiStatic) {
        samples_[places[i]] = {forces[i]->value, 0, std::abs(forces[i]->value)};
      } else {
        samples_[places[i]] = {forces[i]->value, forces[i]->solver_error, 0};
        found_.push_back(places[i]);
      }
    }
    return out;
  }

  /// Returns no nodes if the box is solved at its readings.
  std::vector<Node> nodes_of(const ReadBox& box) const {
    std::vector<Node> out;
    if (box.is_solved) return out;
    for (const MapPlace& place : box.nodes()) out.push_back({place, &samples_.at(place)});
    return out;
  }

  MapSample sample_at(const ReadBox& box, const std::vector<Node>& nodes,
                      const MapPlace& place) const {
    if (box.is_solved) return samples_.at(place);
    MapSample out;
    const auto weights = box.weights_at(place);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      out.force += weights[k] * nodes[k].sample->force;
      out.solver_error += std::abs(weights[k]) * nodes[k].sample->solver_error;
      out.doubt += std::abs(weights[k]) * nodes[k].sample->doubt;
    }
    return out;
  }

  void evaluate(ReadBox& box) const {
    const std::vector<Node> nodes = nodes_of(box);
    std::vector<double> forces;
    for (const Node& node : nodes) forces.push_back(node.sample->force);
    box.deviation = box.deviations(forces);
    box.sums = {};
    for (const std::size_t i : box.readings) {
      const auto& [place, distance] = readings_[i];
      box.sums.add(sample_at(box, nodes, place), distance);
      if (box.is_solved) continue;
      box.sums.interpolation_error +=
          kErrorFactor * box.linear_error(box.deviation, place) * distance;
    }
  }

  void add(std::vector<ReadBox> fresh) {
    solve(places_of(fresh));
    for (ReadBox& box : fresh) {
      evaluate(box);
      boxes_.push_back(std::move(box));
    }
  }

  /// Returns what replaces a box: its halves, or itself, solved at its readings, if these are fewer
  /// than the new nodes of the halves, or if the map has as many places as all readings.
  std::vector<ReadBox> parts_of(const ReadBox& box, std::size_t map_places) const {
    const auto d = static_cast<std::size_t>(
        std::max_element(box.deviation.begin(), box.deviation.end()) - box.deviation.begin());
    const double middle = box.centre()[d];
    std::vector<ReadBox> halves(2);
    for (ReadBox& half : halves) {
      half.low = box.low;
      half.high = box.high;
    }
    halves[0].high[d] = halves[1].low[d] = middle;
    for (const std::size_t i : box.readings) {
      halves[readings_[i].place[d] < middle ? 0 : 1].readings.push_back(i);
    }
    std::erase_if(halves, [](const ReadBox& half) { return half.readings.empty(); });
    for (ReadBox& half : halves) half.is_solved = has_few_readings(half);
    const bool is_divisible = box.low[d] < middle && middle < box.high[d];
    if (is_divisible && map_places < readings_.size() &&
        places_of(halves).size() < box.readings.size()) {
      return halves;
    }
    ReadBox solved = box;
    solved.is_solved = true;
    return {solved};
  }

  void refine() {
    while (refine_once()) {
    }
  }

  /// Divides the boxes with the largest errors until those of the others are well within the
  /// allowed error. Returns false if no box has to be, or may be, divided.
  bool refine_once() {
    const MapSums sums = total();
    const double most = wanted();
    const double allowed = sums.doubt < most ? std::max(most - sums.doubt, 0.1 * most) : most;
    if (!(sums.interpolation_error > allowed)) return false;  // also if NaN
    std::sort(boxes_.begin(), boxes_.end(), [](const ReadBox& one, const ReadBox& other) {
      return one.sums.interpolation_error > other.sums.interpolation_error;
    });
    double left = sums.interpolation_error;
    std::size_t divided = 0, places = samples_.size();
    std::vector<ReadBox> fresh;
    for (; divided < boxes_.size() && left > kShareLeft * allowed; ++divided) {
      const ReadBox& box = boxes_[divided];
      std::vector<ReadBox> parts = parts_of(box, places);
      places += places_of(parts).size();
      if (places > static_cast<std::size_t>(options_.most_points)) break;
      left -= box.sums.interpolation_error;
      std::move(parts.begin(), parts.end(), std::back_inserter(fresh));
    }
    boxes_.erase(boxes_.begin(), boxes_.begin() + static_cast<std::ptrdiff_t>(divided));
    add(std::move(fresh));
    return divided > 0;
  }

  /// Searches thoroughly at the places whose doubt adds most to the error, if a few of them leave
  /// less than half of the wanted error.
  void search_doubtful_places() {
    std::map<MapPlace, double> doubts;  // [J]
    for (const ReadBox& box : boxes_) {
      const std::vector<Node> nodes = nodes_of(box);
      for (const std::size_t i : box.readings) {
        const auto& [place, distance] = readings_[i];
        if (box.is_solved) doubts[place] += samples_.at(place).doubt * distance;
        const auto weights = box.weights_at(place);
        for (std::size_t k = 0; k < nodes.size(); ++k) {
          doubts[nodes[k].place] += std::abs(weights[k]) * nodes[k].sample->doubt * distance;
        }
      }
    }
    std::vector<std::pair<double, MapPlace>> largest;
    for (const auto& [place, doubt] : doubts) largest.emplace_back(doubt, place);
    std::sort(largest.rbegin(), largest.rend());
    double excess = total().doubt - 0.5 * wanted();
    std::size_t count = 0;
    while (excess > 0 && count < std::min(largest.size(), kMostThorough)) {
      excess -= largest[count++].first;
    }
    if (excess > 0) return;
    for (std::size_t k = 0; k < count; ++k) {
      try {
        set_found({largest[k].second}, LossEffort::kThorough);
      } catch (const Refusal&) {  // then the quasi-static model's answer remains
      }
    }
    for (ReadBox& box : boxes_) evaluate(box);
  }

  std::vector<MapReading> readings_;  // one for each place
  const LossForces& loss_forces_;
  const LossMapOptions options_;
  double light_torque_;  // magnitude [N m]; 0 without a map
  MapBox whole_;
  std::map<MapPlace, MapSample> samples_;
  std::vector<ReadBox> boxes_;
  std::vector<MapPlace> found_, missed_;  // places at which a response was searched for
};

}  // namespace

MappedLoss map_losses(const std::vector<MapReading>& readings, const LossForces& loss_forces,
                      const LossMapOptions& options) {
  if (readings.empty()) return {};
  Mapping mapping(readings, loss_forces, options);
  mapping.run();
  return mapping.losses(readings);
}

}  // namespace tribodyn
