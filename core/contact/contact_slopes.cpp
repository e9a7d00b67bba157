// Compiled once per instruction set by foreach_target.h, each time inside a namespace of its own.
// NOLINTBEGIN(bugprone-suspicious-include,misc-redundant-expression)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/contact_slopes.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>

#include "core/contact/slope_stages-inl.h"
#include "core/numerics/dispatch.h"
// NOLINTEND(bugprone-suspicious-include,misc-redundant-expression)

#include "core/contact/contact_slopes.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {
namespace {

template <GrowthMoments Growth>
void differentiate_with(const ContactBlockTables& tables, std::size_t count, const Columns& solved,
                        ContactSlopes& slopes) {
  for (std::size_t i = 0; i < count; i += pack_lanes()) {
    SlopeStages stages;
    eval_conditions(tables, solved, stages, i);
    eval_shared_contact(tables, solved, stages, i);
    eval_mean_stress<Growth>(tables, solved, stages, i);
    put_slopes(tables, solved, stages, slopes, i);
  }
}

}  // namespace

void differentiate(const ContactBlockTables& tables, std::size_t count, const Columns& solved,
                   ContactSlopes& slopes) {
  if (tables.shear.lubricant.pressure_viscosity_law == PressureViscosityLaw::kRoelands) {
    differentiate_with<RoelandsMoments>(tables, count, solved, slopes);
  } else {
    differentiate_with<LawMoments>(tables, count, solved, slopes);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tribodyn {

void ContactSlopes::resize_for_overwrite(std::size_t count) {
  for (Columns* each : {&friction, &temperature}) each->resize_for_overwrite(kContactSlopes, count);
  film_ratio.resize_for_overwrite(kFilmSlopes, count);
  edge.resize_for_overwrite(1, count);
}

void differentiate_contacts(InstructionSet instruction_set, const ContactBlockTables& tables,
                            std::size_t count, const Columns& solved, ContactSlopes& slopes) {
  TRIBODYN_RETURN_WITH(instruction_set, differentiate, tables, count, solved, slopes)
}

}  // namespace tribodyn
#endif
