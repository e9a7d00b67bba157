#include "core/decisions/factor_effects.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>

#include "core/decisions/main_effects.h"

namespace tribodyn {
namespace {

/// Columns of the linear model: what each stands for, and its numbers by candidate.
struct EffectColumns {
  std::vector<FactorEffect> labels;
  std::vector<std::vector<double>> values;
};

void add_number_column(std::size_t factor, const std::vector<double>& numbers, EffectColumns& out) {
  const auto low = std::min_element(numbers.begin(), numbers.end());
  const auto high = std::max_element(numbers.begin(), numbers.end());
  out.labels.push_back({factor,
                        static_cast<std::size_t>(low - numbers.begin()),
                        static_cast<std::size_t>(high - numbers.begin()),
                        0,
                        0,
                        0,
                        {}});
  std::vector<double>& shares = out.values.emplace_back();
  for (const double each : numbers) shares.push_back((each - *low) / (*high - *low));
}

/// Adds a column of zeros and ones for each word but the most frequent one. Returns false if there
/// are too many.
bool add_word_columns(std::size_t factor, const std::vector<std::string>& words,
                      EffectColumns& out) {
  struct Word {
    std::size_t count = 0, first = 0;
  };
  std::map<std::string, Word> found;
  for (std::size_t i = 0; i < words.size(); ++i) {
    Word& word = found[words[i]];
    if (word.count++ == 0) word.first = i;
  }
  if (found.size() > kMostWords) return false;
  const auto usual = std::max_element(
      found.begin(), found.end(),
      [](const auto& one, const auto& other) { return one.second.count < other.second.count; });
  for (const auto& [word, at] : found) {
    if (word == usual->first) continue;
    out.labels.push_back({factor, usual->second.first, at.first, 0, 0, 0, {}});
    std::vector<double>& has_word = out.values.emplace_back();
    for (const std::string& each : words) has_word.push_back(each == word ? 1 : 0);
  }
  return true;
}

template <class Value>
bool is_constant(const std::vector<Value>& values) {
  return std::all_of(values.begin(), values.end(),
                     [&](const Value& each) { return each == values.front(); });
}

bool are_collinear(const std::vector<double>& x, const std::vector<double>& y) {
  const auto rows = static_cast<Eigen::Index>(x.size());
  const Eigen::Map<const Eigen::ArrayXd> a(x.data(), rows), b(y.data(), rows);
  const Eigen::ArrayXd from_a = a - a.mean(), from_b = b - b.mean();
  return std::abs((from_a * from_b).sum()) >
         kCollinear * std::sqrt(from_a.square().sum() * from_b.square().sum());
}

EffectColumns effect_columns(const std::vector<Factor>& factors, FactorEffects& out) {
  EffectColumns columns;
  for (std::size_t k = 0; k < factors.size(); ++k) {
    const Factor& factor = factors[k];
    const bool has_words = factor.numbers.empty();
    if (has_words ? is_constant(factor.words) : is_constant(factor.numbers)) {
      out.left_out.emplace_back(k, NoEffect::kConstant);
    } else if (!has_words) {
      add_number_column(k, factor.numbers, columns);
    } else if (!add_word_columns(k, factor.words, columns)) {
      out.left_out.emplace_back(k, NoEffect::kTooManyWords);
    }
  }
  return columns;
}

}  // namespace

std::optional<FactorEffects> factor_effects(const std::vector<Factor>& factors,
                                            const std::vector<double>& response, double coverage) {
  FactorEffects out{};
  EffectColumns columns = effect_columns(factors, out);
  const auto rows = static_cast<Eigen::Index>(response.size());
  Eigen::MatrixXd matrix(rows, static_cast<Eigen::Index>(columns.values.size()));
  for (std::size_t k = 0; k < columns.values.size(); ++k) {
    matrix.col(static_cast<Eigen::Index>(k)) =
        Eigen::Map<const Eigen::VectorXd>(columns.values[k].data(), rows);
  }
  for (std::size_t k = 0; k < columns.labels.size(); ++k) {
    for (std::size_t other = 0; other < columns.labels.size(); ++other) {
      const std::size_t factor = columns.labels[other].factor;
      if (factor == columns.labels[k].factor ||
          !are_collinear(columns.values[k], columns.values[other])) {
        continue;
      }
      columns.labels[k].collinear.push_back(factor);
    }
  }
  const auto found =
      main_effects(matrix, Eigen::Map<const Eigen::VectorXd>(response.data(), rows), coverage);
  if (!found) return std::nullopt;
  out.degrees_of_freedom = found->degrees_of_freedom;
  out.residual_standard_deviation = found->residual_standard_deviation;
  out.explained_share = found->explained_share;
  for (std::size_t k = 0; k < columns.labels.size(); ++k) {
    FactorEffect& label = columns.labels[k];
    const auto& effect = found->effects[k];
    if (!effect) {
      out.left_out.emplace_back(label.factor, NoEffect::kFollowsFromOthers);
      continue;
    }
    label.effect = effect->effect;
    label.low = effect->low;
    label.high = effect->high;
    out.effects.push_back(label);
  }
  std::stable_sort(out.effects.begin(), out.effects.end(),
                   [](const FactorEffect& one, const FactorEffect& other) {
                     return std::abs(one.effect) > std::abs(other.effect);
                   });
  return out;
}

}  // namespace tribodyn
