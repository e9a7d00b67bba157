#include "core/contact/solved_contacts.h"

#include <iterator>

namespace tribodyn {
namespace {

/// A figure that SolvedContacts stores for each contact. Friction is the first row.
struct SolvedRow {
  double* FlankContactBatchResults::*array;
  double ContactFigures::*member;
};
constexpr SolvedRow kSolvedRows[] = {
    {&FlankContactBatchResults::friction, &ContactFigures::friction},
    {&FlankContactBatchResults::viscous_friction, &ContactFigures::viscous_friction},
    {&FlankContactBatchResults::boundary_friction, &ContactFigures::boundary_friction},
    {&FlankContactBatchResults::contact_temperature, &ContactFigures::contact_temperature},
    {&FlankContactBatchResults::central_film_thickness, &ContactFigures::central_film_thickness},
    {&FlankContactBatchResults::film_ratio, &ContactFigures::film_ratio},
    {&FlankContactBatchResults::maximum_pressure, &ContactFigures::maximum_pressure},
    {&FlankContactBatchResults::shear_rate, &ContactFigures::shear_rate},
    {&FlankContactBatchResults::mean_shear_stress, &ContactFigures::mean_shear_stress},
    {&FlankContactBatchResults::limiting_stress_area_share,
     &ContactFigures::limiting_stress_area_share},
    {&FlankContactBatchResults::asperity_load, &ContactFigures::asperity_load}};
constexpr std::size_t kEllipseLoadRow = std::size(kSolvedRows);  // which ContactFigures lack

}  // namespace

void SolvedContacts::resize(std::size_t count) {
  size_ = count;
  if (count <= room_) return;
  rows_.resize(kEllipseLoadRow + 1, count);
  limiting_stress_at_centre_ = std::make_unique<bool[]>(count);
  by_scalar_kernel_ = std::make_unique<bool[]>(count);
  room_ = count;
}

void SolvedContacts::resize_for_overwrite(std::size_t count) {
  size_ = count;
  if (count <= room_) return;
  rows_.resize_for_overwrite(kEllipseLoadRow + 1, count);
  limiting_stress_at_centre_ = std::make_unique_for_overwrite<bool[]>(count);
  by_scalar_kernel_ = std::make_unique_for_overwrite<bool[]>(count);
  room_ = count;
}

FlankContactBatchResults SolvedContacts::results() {
  FlankContactBatchResults out;
  for (std::size_t r = 0; r < std::size(kSolvedRows); ++r) out.*kSolvedRows[r].array = rows_[r];
  out.ellipse_load = rows_[kEllipseLoadRow];
  out.limiting_stress_at_centre = limiting_stress_at_centre_.get();
  out.by_scalar_kernel = by_scalar_kernel_.get();
  return out;
}

const double* SolvedContacts::column(double ContactFigures::*figure) const {
  std::size_t row = 0;
  while (kSolvedRows[row].member != figure) ++row;
  return rows_[row];
}

double SolvedContacts::ellipse_load(std::size_t i) const { return rows_[kEllipseLoadRow][i]; }

void SolvedContacts::copy(std::size_t i, ContactFigures& to) const {
  to.status = ContactStatus::kOk;
  for (std::size_t r = 0; r < std::size(kSolvedRows); ++r) to.*kSolvedRows[r].member = rows_[r][i];
  to.limiting_stress_at_centre = limiting_stress_at_centre_[i];
}

}  // namespace tribodyn
