#include "server/resources/imports/import_gear_set.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "core/gear/gear_set.h"
#include "server/contract/constraints.h"
#include "server/resources/accept_resource.h"
#include "server/resources/imports/csv_table.h"
#include "server/resources/provenance.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;

constexpr double kMillimetre = 1e-3;
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kPitchSpacingTolerance = 1e-6;  // in pitches
constexpr double kSnapTolerance = 1e-6;

constexpr char kRoll[] = "roll_pitches";
constexpr char kRollAngle[] = "pinion_roll_radians";
constexpr char kPhase[] = "mesh_phase";
constexpr char kSlot[] = "slot";

/// The forms of a column of lengths.
#define TRIBODYN_LENGTH(name) \
  {#name "_metres", #name "_metres"}, { #name "_millimetres", #name "_metres", kMillimetre }
constexpr CsvColumnForm kToothContactForms[] = {
    {kRoll, kRoll},
    {kRollAngle, kRollAngle},
    {"pinion_roll_degrees", kRollAngle, kDegree},
    {kPhase, kPhase},
    {kSlot, kSlot},
    {"load_share", "load_share"},
    TRIBODYN_LENGTH(radius_x),
    TRIBODYN_LENGTH(radius_y),
    TRIBODYN_LENGTH(pinion_velocity_x),
    TRIBODYN_LENGTH(pinion_velocity_y),
    TRIBODYN_LENGTH(gear_velocity_x),
    TRIBODYN_LENGTH(gear_velocity_y),
    TRIBODYN_LENGTH(contact_point_velocity_x),
    TRIBODYN_LENGTH(contact_point_velocity_y),
    TRIBODYN_LENGTH(pinion_friction_arm),
    TRIBODYN_LENGTH(gear_friction_arm),
};
#undef TRIBODYN_LENGTH

constexpr CsvColumnForm kSeriesForms[] = {
    {"quantity", "quantity"}, {"harmonic", "harmonic"}, {"sine", "sine"}, {"cosine", "cosine"}};

bool near(double a, double b, double tolerance) { return std::abs(a - b) <= tolerance; }

/// The rows of a tooth contact table, ordered by slot and sample.
struct RowOrder {
  int samples = 0;               ///< samples of each slot
  std::vector<std::size_t> row;  ///< row of the table at [slot * samples + sample]
};

/// Adds a warning to the provenance of an imported block, unless the client states one.
void note_import(const char* block, const char* source, const std::string& warning,
                 v1::GearSet& gear_set) {
  for (v1::ParameterProvenance& entry : *gear_set.mutable_provenance()) {
    if (entry.field() != block) continue;
    if (entry.warning().empty()) entry.set_warning(warning);
    return;
  }
  v1::ParameterProvenance* entry = gear_set.add_provenance();
  entry->set_field(block);
  entry->set_provenance(v1::PROVENANCE_USER);
  entry->set_source(source);
  entry->set_warning(warning);
}

/// Reads a tooth contact table into the flank slots of a gear set.
class ToothContactReader {
 public:
  ToothContactReader(const CsvTable& table, v1::GearSet& gear_set, Violations& violations)
      : table_(table), gear_set_(gear_set), violations_(violations) {}

  /// Returns false if columns or rows are missing or in an unknown order.
  bool read() {
    const std::size_t before = violations_.size();
    columns_ = match_columns(table_, kToothContactForms, violations_);
    check_columns();
    if (violations_.size() > before) return false;
    read_cells();
    if (find_column(columns_, kPhase) != nullptr) {
      order_by_phase();
    } else {
      order_by_roll();
    }
    if (violations_.size() > before) {
      check_cells();
      return false;
    }
    fill();
    return true;
  }

  std::string locate(int slot, int sample, std::string_view column) const {
    const std::size_t at = index(slot, sample);
    const int line = at < row_order_.row.size() ? table_.rows[row_order_.row[at]].line : 0;
    const CsvColumn* found = find_column(columns_, column);
    return csv_place(table_, line, found == nullptr ? column : found->form.header);
  }

 private:
  std::size_t index(int slot, int sample) const {
    return static_cast<std::size_t>(slot) * static_cast<std::size_t>(row_order_.samples) +
           static_cast<std::size_t>(sample);
  }

  bool has(std::string_view quantity) const { return find_column(columns_, quantity) != nullptr; }

  void add_violation(const std::string& text) { violations_.add(table_.name, text); }

  void check_columns() {
    const int rolls = (has(kRoll) ? 1 : 0) + (has(kRollAngle) ? 1 : 0) + (has(kPhase) ? 1 : 0);
    if (rolls != 1) {
      add_violation(
          "allowed: exactly one of roll_pitches, pinion_roll_radians (or _degrees) and mesh_phase");
    }
    if (has(kPhase) != has(kSlot)) add_violation("mesh_phase and slot need each other");
    const auto& descriptor = *v1::FlankSlot::descriptor();
    for (int i = 0; i < descriptor.field_count(); ++i) {
      const std::string& name = descriptor.field(i)->name();
      const bool optional = name.starts_with("contact_point") || name.ends_with("arm_metres");
      if (!optional && !has(name)) add_violation("has no column " + name);
    }
    if (has("pinion_friction_arm_metres") != has("gear_friction_arm_metres")) {
      add_violation("friction arms of pinion and gear need each other");
    }
    if (has("contact_point_velocity_x_metres") != has("contact_point_velocity_y_metres")) {
      add_violation("contact point velocities x and y need each other");
    }
  }

  std::vector<double> column(std::string_view quantity) {
    return numbers(table_, *find_column(columns_, quantity), EmptyCells::kViolation, violations_);
  }

  void read_cells() {
    const auto& descriptor = *v1::FlankSlot::descriptor();
    for (int i = 0; i < descriptor.field_count(); ++i) {
      const std::string& name = descriptor.field(i)->name();
      if (has(name)) cells_[name] = column(name);
    }
  }

  /// Adds violations for numbers out of range, by row. Only needed if the rows are in no known
  /// order: otherwise accept() makes this check.
  void check_cells() {
    std::size_t count = 0;
    for (const auto& [name, values] : cells_) {
      const Constraint& row = *find_constraint("FlankSlot", name);
      const std::string_view header = find_column(columns_, name)->form.header;
      for (std::size_t i = 0; i < values.size(); ++i) {
        const bool in_range = row.allows(values[i]);
        if (in_range || std::isnan(values[i])) continue;
        if (++count > kMaximumCsvViolations) return;
        violations_.add(csv_place(table_, table_.rows[i].line, header),
                        out_of_range_text(row, values[i]));
      }
    }
  }

  /// Orders rows by roll: one pair from roll -1.5 to 1.5 pitches. The last sample of a slot is the
  /// first of the next one.
  void order_by_roll() {
    const bool by_angle = has(kRollAngle);
    std::vector<double> roll = column(by_angle ? kRollAngle : kRoll);
    if (by_angle) {
      for (double& value : roll) value *= gear_set_.pinion_teeth() / (2 * std::numbers::pi);
    }
    const std::size_t rows = roll.size();
    if (rows < 4 || (rows - 1) % kFlankPairs != 0) {
      return add_violation(fmt::format(
          "{} rows; allowed: 3 n + 1 from roll -1.5 to 1.5 pitches, n intervals a pitch", rows));
    }
    row_order_.samples = static_cast<int>((rows - 1) / kFlankPairs) + 1;
    const double step = 3.0 / static_cast<double>(rows - 1);
    const CsvColumn& header = *find_column(columns_, by_angle ? kRollAngle : kRoll);
    for (std::size_t i = 0; i < rows; ++i) {
      const double expected = -1.5 + step * static_cast<double>(i);
      if (std::isnan(roll[i]) || near(roll[i], expected, kPitchSpacingTolerance)) continue;
      violations_.add(csv_place(table_, table_.rows[i].line, header.form.header),
                      "roll {} pitches; allowed: {}, evenly spaced from -1.5 to 1.5", roll[i],
                      expected);
      if (violations_.size() > kMaximumCsvViolations) return;
    }
    for (int k = 0; k < kFlankPairs; ++k) {
      for (int j = 0; j < row_order_.samples; ++j) {
        row_order_.row.push_back(static_cast<std::size_t>(k) *
                                     static_cast<std::size_t>(row_order_.samples - 1) +
                                 static_cast<std::size_t>(j));
      }
    }
  }

  void order_by_phase() {
    const std::vector<double> phase = column(kPhase);
    const std::vector<double> slot = column(kSlot);
    std::array<std::vector<std::size_t>, kFlankPairs> rows;
    bool all_known = true;
    for (std::size_t i = 0; i < slot.size(); ++i) {
      all_known = all_known && !std::isnan(slot[i]);
      if (std::isnan(slot[i])) continue;
      if (slot[i] == 0 || slot[i] == 1 || slot[i] == 2) {
        rows[static_cast<std::size_t>(slot[i])].push_back(i);
      } else {
        violations_.add(csv_place(table_, table_.rows[i].line, kSlot), "{}; allowed: 0, 1 or 2",
                        slot[i]);
        if (violations_.size() > kMaximumCsvViolations) return;
      }
    }
    const std::size_t samples = rows[0].size();
    if (!all_known) return;
    if (samples < 2 || rows[1].size() != samples || rows[2].size() != samples) {
      return add_violation(
          fmt::format("slots of {}, {} and {} rows; allowed: equal numbers, two or more",
                      rows[0].size(), rows[1].size(), rows[2].size()));
    }
    row_order_.samples = static_cast<int>(samples);
    for (const auto& of_slot : rows) {
      for (std::size_t j = 0; j < samples; ++j) {
        const double expected = static_cast<double>(j) / static_cast<double>(samples - 1);
        row_order_.row.push_back(of_slot[j]);
        if (std::isnan(phase[of_slot[j]]) ||
            near(phase[of_slot[j]], expected, kPitchSpacingTolerance)) {
          continue;
        }
        violations_.add(csv_place(table_, table_.rows[of_slot[j]].line, kPhase),
                        "{}; allowed: {}, evenly spaced from 0 to 1", phase[of_slot[j]], expected);
        if (violations_.size() > kMaximumCsvViolations) return;
      }
    }
  }

  void fill() {
    gear_set_.clear_flank_slots();
    for (int k = 0; k < kFlankPairs; ++k) gear_set_.add_flank_slots();
    const auto& descriptor = *v1::FlankSlot::descriptor();
    for (int i = 0; i < descriptor.field_count(); ++i) {
      const FieldDescriptor& field = *descriptor.field(i);
      const auto known = cells_.find(field.name());
      const std::vector<double> values =
          known != cells_.end() ? known->second : std::vector<double>(table_.rows.size(), 0.0);
      for (int k = 0; k < kFlankPairs; ++k) {
        v1::FlankSlot* slot = gear_set_.mutable_flank_slots(k);
        for (int j = 0; j < row_order_.samples; ++j) {
          slot->GetReflection()->AddDouble(slot, &field, values[row_order_.row[index(k, j)]]);
        }
      }
    }
    if (!has("pinion_friction_arm_metres") && gear_set_.gear_teeth() > 0) fill_friction_arms();
    note_provenance();
  }

  void fill_friction_arms() {
    const double ratio = static_cast<double>(gear_set_.pinion_teeth()) / gear_set_.gear_teeth();
    for (v1::FlankSlot& slot : *gear_set_.mutable_flank_slots()) {
      for (int j = 0; j < row_order_.samples; ++j) {
        const double px = slot.pinion_velocity_x_metres(j), py = slot.pinion_velocity_y_metres(j);
        const double gx = slot.gear_velocity_x_metres(j), gy = slot.gear_velocity_y_metres(j);
        const double x = px - ratio * gx, y = py - ratio * gy;
        const double sliding = std::hypot(x, y);
        if (sliding == 0) continue;
        slot.set_pinion_friction_arm_metres(j, -(x * px + y * py) / sliding);
        slot.set_gear_friction_arm_metres(j, (x * gx + y * gy) / sliding);
      }
    }
  }

  void note_provenance() {
    std::string warning;
    if (!has("pinion_friction_arm_metres")) {
      warning = "friction arms computed from the velocities at the mean speed ratio";
    }
    if (!has("contact_point_velocity_x_metres")) {
      warning += std::string(warning.empty() ? "" : "; ") +
                 "velocities of the contact point not known, taken as 0";
    }
    note_import("flank_slots", "imported tooth contact table", warning, gear_set_);
  }

  const CsvTable& table_;
  v1::GearSet& gear_set_;
  Violations& violations_;
  std::vector<CsvColumn> columns_;
  std::map<std::string, std::vector<double>> cells_;  ///< cells by field of FlankSlot
  RowOrder row_order_;
};

const FieldDescriptor* series_field(const std::string& quantity) {
  const auto* field = v1::MeshSeries::descriptor()->FindFieldByName(quantity);
  return field != nullptr && field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE ? field
                                                                                   : nullptr;
}

std::vector<std::string> series_quantities() {
  std::vector<std::string> out;
  const auto& descriptor = *v1::MeshSeries::descriptor();
  for (int i = 0; i < descriptor.field_count(); ++i) {
    if (series_field(descriptor.field(i)->name()) != nullptr) {
      out.push_back(descriptor.field(i)->name());
    }
  }
  return out;
}

/// Reads a table of Fourier series. The harmonics of each quantity must ascend without gaps.
void read_series(const CsvTable& table, v1::GearSet& gear_set, Violations& violations) {
  const std::size_t before = violations.size();
  const std::vector<CsvColumn> columns = match_columns(table, kSeriesForms, violations);
  for (const CsvColumnForm& form : kSeriesForms) {
    if (find_column(columns, form.quantity) == nullptr) {
      violations.add(table.name, "has no column " + std::string(form.header));
    }
  }
  if (violations.size() > before) return;
  const auto column = [&](std::string_view name, EmptyCells empty) {
    return numbers(table, *find_column(columns, name), empty, violations);
  };
  const std::vector<double> harmonic = column("harmonic", EmptyCells::kViolation);
  const std::vector<double> sine = column("sine", EmptyCells::kAreNaN);
  const std::vector<double> cosine = column("cosine", EmptyCells::kViolation);
  if (violations.size() > before) return;
  const double torque = gear_set.series().pinion_torque_newton_metres();
  v1::MeshSeries series;
  series.set_pinion_torque_newton_metres(torque);
  std::array<int, 8> next{};
  for (std::size_t i = 0; i < table.rows.size() && violations.size() < kMaximumCsvViolations; ++i) {
    const CsvTable::Row& row = table.rows[i];
    const std::string& quantity = row.cells[find_column(columns, "quantity")->index];
    const FieldDescriptor* field = series_field(quantity);
    if (field == nullptr) {
      violations.add(csv_place(table, row.line, "quantity"), "\"{}\" is unknown{}",
                     plain_excerpt(quantity), meant_text(quantity, series_quantities()));
      continue;
    }
    int& expected = next.at(static_cast<std::size_t>(field->index()));
    if (harmonic[i] != expected) {
      violations.add(csv_place(table, row.line, "harmonic"), "{}; allowed: {}, the next one of {}",
                     harmonic[i], expected, quantity);
      continue;
    }
    auto* target =
        static_cast<v1::FourierSeries*>(series.GetReflection()->MutableMessage(&series, field));
    if (expected++ == 0) {
      target->set_mean(cosine[i]);
      if (std::isnan(sine[i]) || sine[i] == 0) continue;
      violations.add(csv_place(table, row.line, "sine"), "allowed: empty or 0 for harmonic 0");
    } else {
      target->add_cosine(cosine[i]);
      target->add_sine(sine[i]);
      if (!std::isnan(sine[i])) continue;
      violations.add(csv_place(table, row.line, "sine"), "is empty; allowed: a number");
    }
  }
  for (const std::string& quantity : series_quantities()) {
    if (next.at(static_cast<std::size_t>(series_field(quantity)->index())) > 0) continue;
    violations.add(table.name, "has no row of " + quantity);
  }
  *gear_set.mutable_series() = std::move(series);
}

void snap_ratio(v1::GearSet& gear_set) {
  if (gear_set.pinion_teeth() <= 0) return;
  v1::MeshSeries& series = *gear_set.mutable_series();
  const double expected = series.pinion_contact_radius_metres().mean() * gear_set.gear_teeth() /
                          gear_set.pinion_teeth();
  const double stated = series.gear_contact_radius_metres().mean();
  const double difference = std::abs(stated - expected);
  if (difference <= kRatioTolerance * std::abs(expected) ||
      !(difference <= kSnapTolerance * std::abs(expected))) {
    return;
  }
  series.mutable_gear_contact_radius_metres()->set_mean(expected);
  const std::string warning = fmt::format("R_g0 = {} m set to R_p0 N_g/N_p", stated);
  note_import("series", "imported series", warning, gear_set);
}

}  // namespace

std::vector<std::string> tooth_contact_headers() { return headers_of(kToothContactForms); }

std::vector<std::string> series_headers() { return headers_of(kSeriesForms); }

std::optional<v1::GearSet> import_gear_set(const v1::ImportGearSetRequest& request,
                                           const std::string& name, const ResourceLookup& lookup,
                                           Violations& violations) {
  const std::size_t before = violations.size();
  v1::GearSet gear_set = request.gear_set();
  gear_set.set_name(name);
  if (!request.series_csv().empty()) {
    const auto table = parse_csv(request.series_csv(), "series_csv", kMaximumCsvBytes, violations);
    if (table) read_series(*table, gear_set, violations);
  }
  if (violations.size() == before) snap_ratio(gear_set);
  const auto table =
      parse_csv(request.tooth_contact_csv(), "tooth_contact_csv", kMaximumCsvBytes, violations);
  const auto refuse = [&]() -> std::optional<v1::GearSet> {
    check_client_fields(gear_set, lookup, "gear_set", violations);
    if (gear_set.has_series()) {
      check_series(gear_set.series(), gear_set, "gear_set.series", violations);
    }
    return std::nullopt;
  };
  if (!table) return refuse();
  ToothContactReader reader(*table, gear_set, violations);
  if (!reader.read() || violations.size() > before) return refuse();
  const auto locate = [&reader](int slot, int sample, std::string_view column) {
    return reader.locate(slot, sample, column);
  };
  return accept(gear_set, LocateSample(locate), lookup, "gear_set", violations);
}

}  // namespace tribodyn::server
