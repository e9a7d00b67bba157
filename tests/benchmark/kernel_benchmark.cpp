#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "core/contact/contact_sensitivity.h"
#include "tests/benchmark/measurements.h"
#include "tests/benchmark/vector_exponential.h"
#include "tests/support/contact_batch.h"
#include "tests/support/realistic_contacts.h"

// Nanoseconds per contact of the friction kernel, one at a time and in batches, and the latter in
// units of the library's vector exponential of the same width; and of the derivatives of solved
// contacts by all inputs, one at a time. Contacts: the reference gear set at
// 20 to 140 km/h, sump 20, 40 and 90 C, three fluids; 256 at a time, and 16 at a time.
// Everything is measured in turns, again and again; figures are medians over the turns.
namespace tribodyn {
namespace {

template <class Work>
double nanoseconds(Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
}

struct SceneContacts {
  FlankContactModel model;
  std::vector<ContactConditions> conditions;
  ContactArrays cold, warm;
};

/// Solves the contacts of all scenes, so many at a time.
std::size_t solve(std::vector<SceneContacts>& scenes, const std::vector<FlankContactBatch>& batches,
                  ContactArrays SceneContacts::*arrays, std::size_t at_a_time) {
  std::size_t by_scalar_kernel = 0;
  for (std::size_t n = 0; n < scenes.size(); ++n) {
    ContactArrays& a = scenes[n].*arrays;
    for (std::size_t first = 0; first < a.size(); first += at_a_time) {
      const std::size_t count = std::min(at_a_time, a.size() - first);
      by_scalar_kernel +=
          batches[n].solve(a.geometries(), first, count, a.conditions(first), a.friction(first));
    }
  }
  return by_scalar_kernel;
}

struct Timings {
  std::vector<double> exponential, large, small, warm;
  std::vector<double> large_ratio, small_ratio, warm_ratio;
};

constexpr int kExponentials = 1024, kExponentialRounds = 64;

double nanoseconds_per_exponential(InstructionSet set) {
  alignas(64) static double x[kExponentials], y[kExponentials];
  for (int i = 0; i < kExponentials; ++i)
    x[i] = -5 + 10.0 * (i * 37 % kExponentials) / kExponentials;
  return nanoseconds([&] {
           for (int n = 0; n < kExponentialRounds; ++n)
             vector_exponential(set, x, y, kExponentials);
         }) /
         (kExponentials * kExponentialRounds);
}

int run(const std::string& path, int turns) {
  std::vector<SceneContacts> scenes;
  std::size_t contacts = 0;
  for (const int fluid : {1, 2, 3}) {
    for (const double sump : {20.0, 40.0, 90.0}) {
      const Scene scene = reference_scene(fluid, sump);
      const FlankContactModel model = contact_model(scene);
      std::vector<ContactConditions> conditions;
      for (double speed = 20; speed <= 140; speed += 10) {
        const auto more = realistic_contacts(scene, speed, 40).conditions;
        conditions.insert(conditions.end(), more.begin(), more.end());
      }
      conditions.resize(conditions.size() / 256 * 256);
      contacts += conditions.size();
      const ContactArrays arrays(conditions, scene.solid, scene.options);
      scenes.push_back({model, conditions, arrays, arrays});
    }
  }
  for (SceneContacts& scene : scenes) {
    scene.warm.solve(FlankContactBatch(scene.model));
    scene.warm.start_from_last_temperature(1.0003);  // some 0.1 K
  }
  const std::vector<InstructionSet> sets = supported_instruction_sets();
  std::vector<std::vector<FlankContactBatch>> batches(sets.size());
  for (std::size_t s = 0; s < sets.size(); ++s) {
    for (const SceneContacts& scene : scenes) batches[s].emplace_back(scene.model, sets[s]);
  }

  std::vector<double> scalar, derivatives, set_up;
  std::vector<Timings> timings(sets.size());
  std::size_t by_scalar_kernel = 0;
  double sum = 0;  // keeps the compiler honest
  for (int turn = 0; turn < turns; ++turn) {
    scalar.push_back(nanoseconds([&] {
                       for (const SceneContacts& scene : scenes) {
                         for (const ContactConditions& k : scene.conditions) {
                           sum += scene.model.solve(k).friction;
                         }
                       }
                     }) /
                     static_cast<double>(contacts));
    derivatives.push_back(nanoseconds([&] {
                            for (SceneContacts& scene : scenes) {
                              const ContactSensitivityModel sensitivity(scene.model);
                              const FlankContactBatchResults solved = scene.warm.results();
                              for (std::size_t i = 0; i < scene.conditions.size(); ++i) {
                                sum += sensitivity
                                           .at(scene.conditions[i], solved.ellipse_load[i],
                                               solved.contact_temperature[i])
                                           .friction.by[0];
                              }
                            }
                          }) /
                          static_cast<double>(contacts));
    set_up.push_back(nanoseconds([&] { FlankContactBatch{scenes[0].model}; }));
    for (std::size_t s = 0; s < sets.size(); ++s) {
      Timings& t = timings[s];
      const auto each = [&](ContactArrays SceneContacts::*arrays, std::size_t at_a_time) {
        return nanoseconds(
                   [&] { by_scalar_kernel += solve(scenes, batches[s], arrays, at_a_time); }) /
               static_cast<double>(contacts);
      };
      t.exponential.push_back(nanoseconds_per_exponential(sets[s]));
      t.large.push_back(each(&SceneContacts::cold, 256));
      t.small.push_back(each(&SceneContacts::cold, 16));
      t.warm.push_back(each(&SceneContacts::warm, 256));
      t.large_ratio.push_back(t.large.back() / t.exponential.back());
      t.small_ratio.push_back(t.small.back() / t.exponential.back());
      t.warm_ratio.push_back(t.warm.back() / t.exponential.back());
    }
  }

  constexpr double kTarget = 70;
  const std::string unit = "vector exponentials";
  std::vector<Measurement> out;
  out.push_back({"friction kernel, one at a time", median(scalar), "ns/contact", {}});
  out.push_back({"derivatives of a solved contact", median(derivatives), "ns/contact", {}});
  out.push_back({"friction kernel, set-up of a batch", median(set_up) / 1000, "us/model", {}});
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const std::string name = std::string(", ") + FlankContactBatch::name(sets[s]);
    const Timings& t = timings[s];
    out.push_back({"vector exponential" + name, median(t.exponential), "ns/value", {}});
    out.push_back({"friction kernel, batch" + name, median(t.large), "ns/contact", {}});
    out.push_back({"friction kernel, batch of 16" + name, median(t.small), "ns/contact", {}});
    out.push_back({"friction kernel, batch, warm" + name, median(t.warm), "ns/contact", {}});
    out.push_back({"friction kernel, batch, ratio" + name, median(t.large_ratio), unit, kTarget});
    out.push_back({"friction kernel, batch of 16, ratio" + name, median(t.small_ratio), unit, {}});
    out.push_back(
        {"friction kernel, batch, warm, ratio" + name, median(t.warm_ratio), unit, kTarget});
  }
  out.push_back({"friction kernel, batch, left to the scalar kernel",
                 static_cast<double>(by_scalar_kernel) /
                     static_cast<double>(contacts * sets.size() * 3 * turns),
                 "share of contacts", 0.0});
  std::printf("%s; %zu contacts, medians of %d turns (check %g)\n", machine_name().c_str(),
              contacts, turns, sum);
  print(out);
  if (!path.empty()) record(path, out);
  return 0;
}

}  // namespace
}  // namespace tribodyn

/// usage: kernel_benchmark [results.json [turns]]
int main(int count, char** arguments) try {
  return tribodyn::run(count > 1 ? arguments[1] : "", count > 2 ? std::atoi(arguments[2]) : 31);
} catch (const std::exception& error) {
  std::fprintf(stderr, "kernel_benchmark: %s\n", error.what());
  return 1;
}
