#include "core/study/map_box.h"

#include <cmath>

namespace tribodyn {

int MapBox::dimensions() const {
  int out = 0;
  for (std::size_t d = 0; d < 3; ++d) out += has_width(d) ? 1 : 0;
  return out;
}

MapPlace MapBox::centre() const {
  MapPlace out{};
  for (std::size_t d = 0; d < 3; ++d) out[d] = 0.5 * (low[d] + high[d]);
  return out;
}

std::vector<MapPlace> MapBox::nodes() const {
  std::vector<MapPlace> out{low};
  const MapPlace middle = centre();
  for (std::size_t d = 0; d < 3; ++d) {
    if (!has_width(d)) continue;
    const std::size_t count = out.size();
    for (const double value : {middle[d], high[d]}) {
      for (std::size_t i = 0; i < count; ++i) {
        MapPlace node = out[i];
        node[d] = value;
        out.push_back(node);
      }
    }
  }
  return out;
}

std::array<double, MapBox::kMostNodes> MapBox::weights_at(const MapPlace& place) const {
  std::array<double, kMostNodes> out{1};
  std::size_t count = 1;
  for (std::size_t d = 0; d < 3; ++d) {
    if (!has_width(d)) continue;
    const double s = share(d, place);
    for (std::size_t i = 0; i < count; ++i) {
      out[2 * count + i] = s * (2 * s - 1) * out[i];
      out[count + i] = 4 * s * (1 - s) * out[i];
      out[i] *= (1 - s) * (1 - 2 * s);
    }
    count *= 3;
  }
  return out;
}

MapPlace MapBox::deviations(const std::vector<double>& values) const {
  MapPlace out{};
  std::size_t step = 1;
  for (std::size_t d = 0; d < 3; ++d) {
    if (!has_width(d)) continue;
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (k / step % 3 != 1) continue;
      const double deviation = std::abs(values[k] - 0.5 * (values[k - step] + values[k + step]));
      if (!(deviation <= out[d])) out[d] = deviation;
    }
    step *= 3;
  }
  return out;
}

double MapBox::linear_error(const MapPlace& deviations, const MapPlace& place) const {
  double out = 0;
  for (std::size_t d = 0; d < 3; ++d) {
    if (has_width(d)) out += 4 * share(d, place) * (1 - share(d, place)) * deviations[d];
  }
  return out;
}

}  // namespace tribodyn
