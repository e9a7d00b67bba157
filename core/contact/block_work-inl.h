// What the stages of contact_block.cpp leave to each other.
// Compiled once per instruction set by contact_block.cpp.
#if defined(TRIBODYN_CORE_CONTACT_BLOCK_WORK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_CONTACT_BLOCK_WORK_INL_H_
#undef TRIBODYN_CORE_CONTACT_BLOCK_WORK_INL_H_
#else
#define TRIBODYN_CORE_CONTACT_BLOCK_WORK_INL_H_
#endif

#include <hwy/highway.h>

#include "core/contact/contact_block.h"
#include "core/numerics/pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {
namespace {

using Tables = ContactBlockTables;

/// What one stage leaves to the next. Stages are short loops over the block: a processor then works
/// on several contacts at a time, and all that a stage needs stays in registers.
struct alignas(64) Work {
  using Lanes = ContactLanes;
  Lanes in_range;  // 1 or 0: conditions, film and load sharing are such as the vector code solves
  Lanes slide2, log_along, log_across, log_speed2, log_load;
  Lanes film_under_all, load_root;  // h_cen if the film carried all, W^(1/3)
  // Load sharing: r = ln(W_EHL/W), e^(r/3), h_cen/h_cen(r = 0), and the asperities there.
  Lanes asperities, log_share, share_root, thinner, film_ratio, gaussian, inverse, fall, f5_2,
      lowest, last_change;
  Lanes contact_area, asperity_area;
  // Heat: T = base + gain tau_bar.
  Lanes viscous_area, gain, base, log_shear_rate;
  Lanes scaled_pressure, per_scaled;     // c p_max, 1/(c p_max)
  Lanes end, end_growth, end_log_limit;  // s = ln(1 + c p) at the centre or the table's end,
                                         // e^(Z s) - 1 and ln tau_L there
  Lanes all_limit;                       // tau_bar where all sits on tau_L
  // The iteration: T - base and the s where tau meets tau_L; eq 23 at that T; tau at that s.
  Lanes start, rise, cut, pending;
  Lanes law_base, law_base_slope, factor, factor_slope;
  Lanes clipped, e_cut, stress, log_slope, depth_slope;  // slopes of ln tau by T and by s
  Lanes ratio, ratio_slope;
  // Of contacts limited at the edge: c p and s where tau leaves tau_L, and tau, its slopes in T and
  // c p and R there.
  Lanes rim, rim_depth, rim_stress, rim_log_slope, rim_steepness, rim_ratio, rim_ratio_slope;
  Lanes all_limited;  // 1 or 0: tau is above tau_L everywhere
  Lanes mean, change, cut_change, rim_change;
};

/// First lanes of the packs of a block that are still worked on.
class ActiveLanes {
 public:
  explicit ActiveLanes(int count) {
    for (int i = 0; i < count; i += pack_lanes()) lane_[count_++] = i;
  }
  const int* begin() const { return lane_; }
  const int* end() const { return lane_ + count_; }
  bool empty() const { return count_ == 0; }
  /// Goes through all and keeps those for which `stays` is true.
  template <class Function>
  HWY_INLINE void keep(Function&& stays) {
    int kept = 0;
    for (int n = 0; n < count_; ++n) {
      const int i = lane_[n];
      lane_[kept] = i;
      kept += stays(i) ? 1 : 0;
    }
    count_ = kept;
  }

 private:
  int lane_[kBlockContacts];
  int count_ = 0;
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif  // TRIBODYN_CORE_CONTACT_BLOCK_WORK_INL_H_
