#include "server/simulation/contact_uncertainty.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/numerics/square.h"
#include "core/refusal.h"
#include "core/uncertainty/normal_draws.h"
#include "core/uncertainty/spread.h"
#include "server/simulation/input_deviations.h"
#include "server/simulation/input_errors.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;

constexpr std::uint64_t kContactSeed = 1;  // any: equal requests give equal answers

std::vector<const FieldDescriptor*> contact_figures() {
  const auto& descriptor = *v1::EvaluateContactResponse::descriptor();
  std::vector<const FieldDescriptor*> out;
  for (int i = 0; i < descriptor.field_count(); ++i) {
    const FieldDescriptor* field = descriptor.field(i);
    if (field->cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE) out.push_back(field);
  }
  return out;
}

double figure_of(const v1::EvaluateContactResponse& contact, const FieldDescriptor* figure) {
  return contact.GetReflection()->GetDouble(contact, figure);
}

/// Contacts with a lubricant whose parameters err.
class ErringContact {
 public:
  ErringContact(const v1::Lubricant& lubricant, const InputErrors& errors,
                const SolveContact& solve)
      : errors_(errors), solve_(solve) {
    inputs_.lubricant = lubricant;
    inputs_.lubricant.clear_measurements();
    inputs_.lubricant.clear_provenance();
    Deviations deviations(0);  // of one lubricant alone: nothing is correlated
    for (const InputError& error : errors.errors) {
      mixtures_.push_back(deviations.of(error, ""));
      deviations_.emplace_back(mixtures_.back().size(), 0.0);
    }
    count_ = deviations.count();
  }

  int count() const { return count_; }

  std::optional<v1::EvaluateContactResponse> drawn(const NormalDraws& draws, int draw) {
    for (std::size_t e = 0; e < deviations_.size(); ++e) {
      for (std::size_t i = 0; i < deviations_[e].size(); ++i) {
        deviations_[e][i] = mixtures_[e][i].at(draws, draw);
      }
    }
    return contact();
  }

  /// With one deviation of one error, all others 0.
  std::optional<v1::EvaluateContactResponse> moved(std::size_t error, std::size_t which,
                                                   double deviation) {
    for (auto& each : deviations_) std::fill(each.begin(), each.end(), 0.0);
    deviations_[error][which] = deviation;
    return contact();
  }

  std::size_t deviations_of(std::size_t error) const { return deviations_[error].size(); }

 private:
  std::optional<v1::EvaluateContactResponse> contact() {
    for (std::size_t e = 0; e < deviations_.size(); ++e) {
      errors_.errors[e].apply(deviations_[e], inputs_);
    }
    try {
      return solve_(inputs_.lubricant);
    } catch (const Refusal&) {
      return std::nullopt;
    }
  }

  const InputErrors& errors_;
  const SolveContact& solve_;
  UncertainInputs inputs_;
  std::vector<std::vector<Mixture>> mixtures_;
  std::vector<std::vector<double>> deviations_;  // by error
  int count_ = 0;
};

/// The linear model: what each error does to each figure.
struct LinearEffects {
  std::vector<double> variance;         // by figure
  std::vector<double> friction_change;  // by error: of the friction coefficient
};

LinearEffects linear_effects(const std::vector<const FieldDescriptor*>& figures,
                             const InputErrors& errors, ErringContact& erring,
                             const v1::EvaluateContactResponse& stated) {
  LinearEffects out{std::vector<double>(figures.size(), 0.0), {}};
  for (std::size_t e = 0; e < errors.errors.size(); ++e) {
    double squares = 0, change = 0;
    for (std::size_t i = 0; i < erring.deviations_of(e); ++i) {
      const auto plus = erring.moved(e, i, 1), minus = erring.moved(e, i, -1);
      const v1::EvaluateContactResponse& high = plus ? *plus : stated;
      const v1::EvaluateContactResponse& low = minus ? *minus : stated;
      const double sides = plus && minus ? 2 : 1;
      for (std::size_t f = 0; f < figures.size(); ++f) {
        out.variance[f] +=
            square((figure_of(high, figures[f]) - figure_of(low, figures[f])) / sides);
      }
      change = (high.friction_coefficient() - low.friction_coefficient()) / sides;
      squares += square(change);
    }
    out.friction_change.push_back(erring.deviations_of(e) == 1 ? change : std::sqrt(squares));
  }
  return out;
}

void add_friction_shares(const InputErrors& errors, const LinearEffects& effects,
                         v1::EvaluateContactResponse& response) {
  double variance = 0;
  for (const double change : effects.friction_change) variance += square(change);
  for (std::size_t e = 0; e < errors.errors.size(); ++e) {
    const double change = effects.friction_change[e];
    v1::InputShare& share = *response.add_friction_shares();
    share.set_input(errors.errors[e].input);
    share.set_effect(change);
    share.set_variance_share(variance > 0 ? square(change) / variance : 0);
  }
  std::stable_sort(response.mutable_friction_shares()->begin(),
                   response.mutable_friction_shares()->end(),
                   [](const v1::InputShare& a, const v1::InputShare& b) {
                     return a.variance_share() > b.variance_share();
                   });
}

}  // namespace

void add_uncertainties(const v1::Lubricant& lubricant, int draws, const SolveContact& solve,
                       v1::EvaluateContactResponse& response) {
  const InputErrors errors = lubricant_errors(lubricant);
  for (const std::string& each : errors.without_uncertainty) {
    response.add_inputs_without_uncertainty(each);
  }
  if (errors.errors.empty()) return;
  ErringContact erring(lubricant, errors, solve);
  const std::vector<const FieldDescriptor*> figures = contact_figures();
  const LinearEffects effects = linear_effects(figures, errors, erring, response);
  const NormalDraws normal(draws, erring.count(), kContactSeed);
  std::vector<std::vector<double>> drawn(figures.size());
  for (int n = 0; n < draws; ++n) {
    const auto contact = erring.drawn(normal, n);
    if (!contact) {
      response.set_refused_draws(response.refused_draws() + 1);
      continue;
    }
    for (std::size_t f = 0; f < figures.size(); ++f) {
      drawn[f].push_back(figure_of(*contact, figures[f]));
    }
  }
  for (std::size_t f = 0; f < figures.size(); ++f) {
    const double stated = figure_of(response, figures[f]);
    if (!std::isfinite(stated)) continue;
    const Spread spread = spread_of_draws(std::move(drawn[f]), draws, stated);
    if (spread.standard_deviation == 0) continue;
    v1::UncertainContactFigure& added = *response.add_uncertainties();
    added.set_figure(figures[f]->name());
    v1::UncertainFigure& figure = *added.mutable_value();
    figure.set_value(stated);
    figure.set_standard_uncertainty(spread.standard_deviation);
    figure.set_interval_minimum(spread.low);
    figure.set_interval_maximum(spread.high);
    figure.set_linear_standard_uncertainty(std::sqrt(effects.variance[f]));
  }
  add_friction_shares(errors, effects, response);
}

}  // namespace tribodyn::server
