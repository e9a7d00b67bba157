#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/contact/flank_contact.h"
#include "core/model_options.h"

namespace tribodyn {

/// What the friction kernel needs of the geometry of many contact points. It depends on neither
/// load, speed nor fluid: prepare it once per mesh phase, share it between fluids and speeds.
/// Not synchronised: set first, then read from as many threads as you like.
class ContactGeometries {
 public:
  /// reduced_modulus E' of eq 13 [Pa]; of the options, hertz_solution and as_published count.
  ContactGeometries(double reduced_modulus, const ModelOptions& options, std::size_t count = 0);

  void resize(std::size_t count);
  std::size_t size() const { return radius_x_.size(); }

  /// Contact i: effective radii R_zx, R_zy [m]. Any value is accepted; impossible ones are refused
  /// by name when they are solved.
  void set(std::size_t i, double radius_x, double radius_y);

  double radius_x(std::size_t i) const { return radius_x_[i]; }
  double radius_y(std::size_t i) const { return radius_y_[i]; }

 private:
  friend class FlankContactBatch;

  double reduced_modulus_;
  HertzSolution hertz_solution_;
  AsPublished as_published_;
  std::vector<double> radius_x_, radius_y_;
  std::vector<double> semi_x_, semi_y_;   // semi-axes at 1 N along x and y [m]
  std::vector<double> maximum_pressure_;  // p_max at 1 N [Pa]
};

/// Loads and surface velocities, one array each; see ContactConditions.
struct FlankContactBatchConditions {
  const double* load;               ///< W [N]
  const double* pinion_velocity_x;  ///< u_s,p [m/s]
  const double* pinion_velocity_y;  ///< v_s,p [m/s]
  const double* gear_velocity_x;    ///< u_s,g [m/s]
  const double* gear_velocity_y;    ///< v_s,g [m/s]
};

/// Where the figures of ContactSolution of the same names go, one array each. A null pointer is a
/// figure that is not wanted.
struct FlankContactBatchResults {
  double* friction = nullptr;                    ///< F_fr [N]
  double* viscous_friction = nullptr;            ///< F_v [N]
  double* boundary_friction = nullptr;           ///< F_b [N]
  double* contact_temperature = nullptr;         ///< T_c [K]
  double* central_film_thickness = nullptr;      ///< h_cen [m]
  double* film_ratio = nullptr;                  ///< lambda_s [-]
  double* maximum_pressure = nullptr;            ///< p_max [Pa]
  double* film_load = nullptr;                   ///< W_EHL [N]
  double* asperity_load = nullptr;               ///< W_asp [N]
  double* sliding_speed = nullptr;               ///< V_s [m/s]
  double* shear_rate = nullptr;                  ///< gamma_dot [1/s]
  double* mean_shear_stress = nullptr;           ///< tau_bar [Pa]
  double* limiting_stress_area_share = nullptr;  ///< [-]
  bool* limiting_stress_at_centre = nullptr;
  ContactStatus* status = nullptr;
};

/// Which instructions a batch is solved with.
enum class InstructionSet {
  kPortable,  ///< what every CPU of the architecture has
  kAvx2,      ///< AVX2 with fused multiply-add
  kAvx512,    ///< AVX-512 F, BW, DQ, VL
};

/// The friction kernel of FlankContactModel for many contacts at once.
///
/// Same laws, same answers: every figure is within 1e-10 of FlankContactModel::solve (relative).
/// Contacts that the vector code does not cover (kernel_fallbacks in the .cpp) are handed to that
/// reference one by one and then agree to the last bit.
///
/// A contact's result depends on the model, on its own geometry and conditions and on the
/// instruction set, and on nothing else: the same bits alone or in company, in any place of a batch
/// of any size. kAvx2 and kAvx512 give the same bits; kPortable has no fused multiply-add where
/// the architecture lacks it, and differs from them in the last digits. So the name of the
/// instruction set belongs to the version of the model that is stated with a result.
///
/// Immutable after construction, safe for concurrent use; `solve` allocates nothing and never
/// throws.
class FlankContactBatch {
 public:
  /// Builds the tables of the model's fluid (some 20 us). Throws nothing but std::bad_alloc.
  explicit FlankContactBatch(const FlankContactModel& model);
  FlankContactBatch(const FlankContactModel& model, InstructionSet instruction_set);
  ~FlankContactBatch();
  FlankContactBatch(FlankContactBatch&&) noexcept;
  FlankContactBatch& operator=(FlankContactBatch&&) noexcept;

  /// The widest instruction set of this CPU, and whether it has a given one.
  static InstructionSet widest();
  static bool supported(InstructionSet instruction_set);
  /// "portable", "avx2", "avx512".
  static const char* name(InstructionSet instruction_set);

  InstructionSet instruction_set() const { return instruction_set_; }
  const FlankContactModel& model() const { return model_; }

  /// Solves contacts first ... first + count - 1 of `geometries`; element i of each array belongs
  /// to contact first + i. Results may not overlap conditions. Returns how many contacts under load
  /// went to the reference.
  std::size_t solve(const ContactGeometries& geometries, std::size_t first, std::size_t count,
                    const FlankContactBatchConditions& conditions,
                    const FlankContactBatchResults& results) const;

 private:
  struct Tables;

  FlankContactModel model_;
  InstructionSet instruction_set_;
  std::unique_ptr<const Tables> tables_;
};

}  // namespace tribodyn
