#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/contact/contact_slopes.h"
#include "core/contact/flank_contact.h"
#include "core/model_options.h"
#include "core/numerics/digits.h"
#include "core/numerics/instruction_set.h"

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

  /// Contact i: the same as contact j of `from`, which is of the same material and options.
  void copy(std::size_t i, const ContactGeometries& from, std::size_t j);

  double radius_x(std::size_t i) const { return radius_x_[i]; }
  double radius_y(std::size_t i) const { return radius_y_[i]; }

 private:
  friend class FlankContactBatch;
  friend class DifferentiatedContacts;

  double reduced_modulus_;
  HertzSolution hertz_solution_;
  AsPublished as_published_;
  std::vector<double> radius_x_, radius_y_;
  std::vector<double> curvature_x_, curvature_y_;  // 1/R, 0 for an impossible one
  std::vector<double> unit_area_;                  // A_EHL at 1 N [m2]
  std::vector<double> per_semi_x_, per_semi_y_;    // over the semi-axes at 1 N along x and y [1/m]
  std::vector<double> maximum_pressure_;           // p_max at 1 N [Pa]
};

/// Loads and surface velocities, one array each; see ContactConditions.
struct FlankContactBatchConditions {
  const double* load;          ///< W [N]
  const double* velocity_1_x;  ///< u_s,p [m/s]
  const double* velocity_1_y;  ///< v_s,p [m/s]
  const double* velocity_2_x;  ///< u_s,g [m/s]
  const double* velocity_2_y;  ///< v_s,g [m/s]
  /// Temperatures near T_c to start from [K], such as a previous sweep's: saves a tenth of the
  /// time. Null, or 0 for a contact: none. They change results by less than 1e-10.
  const double* start_temperature = nullptr;
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
  double* ellipse_load = nullptr;                ///< W_EHL of eq 41 [N]
  double* asperity_load = nullptr;               ///< W_asp [N]
  double* sliding_speed = nullptr;               ///< V_s [m/s]
  double* shear_rate = nullptr;                  ///< gamma_dot [1/s]
  double* mean_shear_stress = nullptr;           ///< tau_bar [Pa]
  double* limiting_stress_area_share = nullptr;  ///< [-]
  bool* limiting_stress_at_centre = nullptr;
  ContactStatus* status = nullptr;
  bool* by_scalar_kernel = nullptr;  ///< FlankContactModel solved it
};

/// Contacts that FlankContactBatch has solved and certified, and their derivatives.
class DifferentiatedContacts {
 public:
  /// Removes all and makes room for so many.
  void clear(std::size_t room);
  int size() const { return count_; }

  /// What a solution has found of a contact, as in FlankContactBatchResults.
  struct Solved {
    double ellipse_load, contact_temperature, mean_shear_stress, limiting_stress_area_share;
  };
  /// Adds a contact with the geometry of number i of `geometries`. Both surfaces must move. Returns
  /// the contact's place in the rows of slopes().
  int add(const ContactGeometries& geometries, std::size_t i, const ContactConditions& conditions,
          const Solved& solved);

  /// Once FlankContactBatch::differentiate() has filled them in.
  const ContactSlopes& slopes() const { return slopes_; }

 private:
  friend class FlankContactBatch;

  int count_ = 0;
  Columns solved_;  // SolvedContactRow
  ContactSlopes slopes_;
};

/// The friction kernel of FlankContactModel for many contacts at once.
///
/// Same laws, same answers: every figure is within 1e-10 of FlankContactModel::solve (relative;
/// shares of an area absolute), on reference contacts within 3e-11. With half of the digits, for
/// two thirds of the time, they are within 3e-5, on realistic contacts within 2e-6 (friction and
/// load of asperities relative to those of the contact). What differs is the way there:
/// - The mean of eq 23 needs no quadrature. With L = ln eta_0 + 9.67 and c of eq 31,
///     int_0^p tau p' dp' = tau(p) p^2/2 R(L, ln(1 + c p)),
///   where R depends on the fluid's Z alone and is a polynomial in two variables, made once.
/// - The places where tau meets tau_L and the temperature are found by one iteration. tau is convex
///   in p and tau_L a line, so that there are two at most: the end of a rim on tau_L, which
///   tau_L0 = 0 always has, and one towards the centre.
///
/// Handed to the scalar kernel, one by one and then equal to it to the last bit:
/// - models with the misprints of eqs 17, 31, 32, 43 and 44, with the ellipse from the total load,
///   with a limiting stress of zero (tau_L0 = gamma_L = 0) or a density that rises with
///   temperature; without limiting stress, fluids that may have several thermal equilibria;
/// - contacts without load, sliding or entrainment, or with any of them, or a radius, far beyond
///   machines (1e-10 N, 1e-9 m/s, 1 um); refused ones;
/// - an unlimited stress above 3 GPa (less where the viscosity rises by more than e^32); T_c more
///   than 200 K above the inlet; film ratios between 36.5 and 38.75;
/// - a stress that is within 1e-8 of the limit at the edge or the centre (1e-6 with half of the
///   digits), or that falls to within 1 % of the limit behind a limited rim and rises again; a rise
///   of temperature that might lead to several equilibria.
///
/// A contact's result depends on the model, on its own geometry, conditions and start, and on the
/// instruction set, and on nothing else: the same bits alone or in company, in any place of a batch
/// of any size. kAvx2 and kAvx512 give the same bits; kPortable has no fused multiply-add where
/// the architecture lacks it, and differs from them in the last digits. So the name of the
/// instruction set belongs to the version of the model that is stated with a result.
///
/// Immutable after construction, safe for concurrent use; `solve` allocates nothing and never
/// throws. Batches should be multiples of 32 contacts, in places next to each other.
class FlankContactBatch {
 public:
  /// Builds the tables of the model's fluid (some 10 us; a few ms the first time).
  /// `instruction_set` must be supported. Throws nothing but std::bad_alloc.
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
  /// went to the scalar kernel.
  std::size_t solve(const ContactGeometries& geometries, std::size_t first, std::size_t count,
                    const FlankContactBatchConditions& conditions,
                    const FlankContactBatchResults& results, Digits digits = Digits::kFull) const;

  /// Fills in the derivatives of contacts that solve() has solved, not by the scalar kernel: those
  /// that ContactSensitivityModel has by conditions, and by ContactLevel instead of by parameters.
  /// Unlike those of results, the last digits of derivatives depend on the neighbouring contacts
  /// and on the width of the vectors: every lane takes the greatest number of quadrature nodes that
  /// a lane beside it needs.
  void differentiate(DifferentiatedContacts& contacts) const;

 private:
  struct Tables;

  FlankContactModel model_;
  InstructionSet instruction_set_;
  std::unique_ptr<const Tables> tables_;
};

}  // namespace tribodyn
