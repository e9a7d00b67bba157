#include "core/numerics/students_t.h"

#include <boost/math/distributions/students_t.hpp>

namespace tribodyn {

double students_t_quantile(double degrees_of_freedom, double probability) {
  using Policy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
  return quantile(boost::math::students_t_distribution<double, Policy>(degrees_of_freedom),
                  probability);
}

}  // namespace tribodyn
