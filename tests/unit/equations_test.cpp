#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/paths.h"

// The mark `// (eq N)` ends the line of the formula of the paper's equation N, once in all of core.
// core/EQUATIONS.md is the list of these lines; TRIBODYN_RENEW_EQUATIONS=1 writes the list anew.

namespace tribodyn {
namespace {

constexpr int kEquations = 48;
constexpr std::array<const char*, kEquations> kSubjects = {
    "acceleration of the pinion shaft",
    "acceleration of the pinion",
    "acceleration of the ring gear",
    "acceleration of the wheel",
    "backlash",
    "dynamic transmission error",
    "torque of the road load",
    "contact radius of the gear",
    "contact radius of the pinion",
    "mesh stiffness",
    "static transmission error",
    "central film thickness",
    "reduced modulus",
    "inlet temperature",
    "radius along the entrainment",
    "radius across the entrainment",
    "entrainment speed",
    "shear rate",
    "contact pressure",
    "semi-axes of the ellipse",
    "ellipticity",
    "elliptic integral",
    "shear stress",
    "shear thinning",
    "time-temperature shift",
    "density",
    "viscous friction",
    "friction of a flank",
    "friction torque",
    "inefficiency",
    "viscosity under pressure",
    "pressure-viscosity index",
    "pressure-viscosity coefficient",
    "ambient viscosity",
    "thermal resistances",
    "active length",
    "heat partition",
    "contact temperature",
    "flash and oil temperature rise",
    "boundary friction",
    "asperity load",
    "asperity area",
    "F_5/2 as a polynomial",
    "F_2 as a polynomial",
    "spectral moments",
    "isotropic moments",
    "composite moments",
    "Greenwood-Tripp parameters",
};

std::filesystem::path core_folder() {
  return std::filesystem::path(test_data_file("x")).parent_path().parent_path().parent_path() /
         "core";
}

struct Mark {
  std::string file, formula;
};

/// Returns the number in a mark `// (eq N)` at the end of a line; 0 if the line has none.
int marked_equation(const std::string& line) {
  static const std::string kMark = "// (eq ";
  const std::size_t mark = line.rfind(kMark);
  if (mark == std::string::npos || !line.ends_with(')')) return 0;
  const std::string number =
      line.substr(mark + kMark.size(), line.size() - mark - kMark.size() - 1);
  const bool is_number =
      !number.empty() && number.find_first_not_of("0123456789") == std::string::npos;
  return is_number ? std::stoi(number) : 0;
}

std::map<int, std::vector<Mark>> marks() {
  std::map<int, std::vector<Mark>> out;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(core_folder())) {
    const std::string extension = entry.path().extension();
    if (extension != ".h" && extension != ".cpp") continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      const int number = marked_equation(line);
      if (number == 0) continue;
      const std::size_t comment = line.rfind("//");
      const std::size_t start = line.find_first_not_of(' ');
      std::string formula = comment == std::string::npos ? "" : line.substr(start, comment - start);
      while (!formula.empty() && formula.back() == ' ') formula.pop_back();
      out[number].push_back(
          {std::filesystem::relative(entry.path(), core_folder()).generic_string(), formula});
    }
  }
  return out;
}

std::string table(const std::map<int, std::vector<Mark>>& marks) {
  std::ostringstream out;
  out << "# The paper's equations\n\n"
         "`// (eq N)` ends the line of the formula of equation N and no other line of `core`. A "
         "test writes\nand checks this list (`tests/unit/equations_test.cpp`).\n\n"
         "| eq | what | file | line |\n|---|---|---|---|\n";
  for (const auto& [number, found] : marks) {
    if (number < 1 || number > kEquations) continue;
    for (const Mark& mark : found) {
      out << "| " << number << " | " << kSubjects[number - 1] << " | [" << mark.file << "]("
          << mark.file << ") | `" << mark.formula << "` |\n";
    }
  }
  return out.str();
}

TEST(Equations, StandAtOneFormulaEach) {
  const auto found = marks();
  for (int n = 1; n <= kEquations; ++n) {
    const auto at = found.find(n);
    if (at == found.end()) {
      ADD_FAILURE() << "no formula of core has the mark of eq " << n;
      continue;
    }
    EXPECT_EQ(at->second.size(), 1U)
        << "eq " << n << " is marked in " << at->second[0].file << " and elsewhere";
    for (const Mark& mark : at->second) {
      EXPECT_FALSE(mark.formula.empty())
          << mark.file << ": the mark of eq " << n << " stands beside no formula";
    }
  }
  EXPECT_EQ(found.size(), static_cast<std::size_t>(kEquations)) << "a mark has no such equation";
}

TEST(Equations, AreListedInEquationsMd) {
  const std::string expected = table(marks());
  const std::filesystem::path path = core_folder() / "EQUATIONS.md";
  if (std::getenv("TRIBODYN_RENEW_EQUATIONS") != nullptr) std::ofstream(path) << expected;
  std::ostringstream written;
  written << std::ifstream(path).rdbuf();
  EXPECT_EQ(written.str(), expected) << "TRIBODYN_RENEW_EQUATIONS=1 writes it anew";
}

}  // namespace
}  // namespace tribodyn
