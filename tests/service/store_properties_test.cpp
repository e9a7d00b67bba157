// Any sequence of valid operations keeps the store consistent, and an imported export is exported
// unchanged.
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <map>

#include "google/rpc/code.pb.h"
#include "server/application/simulations.h"
#include "server/contract/constraints.h"
#include "server/contract/output_only.h"
#include "server/storage/maintenance.h"
#include "server/storage/seeds.h"
#include "tests/service/resource_calls.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using google::protobuf::Message;
using google::protobuf::util::JsonStringToMessage;
using google::protobuf::util::MessageToJsonString;

/// A store in its own folder with the objects of its application.
struct Place {
  TemporaryFolder folder;
  Store store{folder.file("tribodyn.db")};
  SimulationJobs jobs{store, [] {
                        SimulationJobs::Options options;
                        options.threads = 1;
                        options.studies = quick_studies();
                        return options;
                      }()};
  Application app{store, jobs};
};

/// Generates a number in the closed range of its row.
rc::Gen<double> allowed_number(const Constraint& row) {
  return rc::gen::map(rc::gen::inRange(0, 1001), [row](int step) {
    const double t = step / 1000.0;
    if (step == 0) return row.minimum;
    if (step == 1000) return row.maximum;
    return row.minimum > 0 ? row.minimum * std::pow(row.maximum / row.minimum, t)
                           : row.minimum + t * (row.maximum - row.minimum);
  });
}

std::string any_text() { return *rc::gen::container<std::string>(rc::gen::inRange(' ', '~')); }

/// Replaces some numbers that have rows in the table by other allowed values.
void vary_numbers(Message& message) {
  const auto& descriptor = *message.GetDescriptor();
  for (int i = 0; i < descriptor.field_count(); ++i) {
    const auto* field = descriptor.field(i);
    const Constraint* row = find_constraint(descriptor.name(), field->name());
    if (row == nullptr || field->is_repeated() || *rc::gen::inRange(0, 3) != 0) continue;
    if (field->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE) {
      message.GetReflection()->SetDouble(&message, field, *allowed_number(*row));
    }
  }
}

/// The methods of one kind of resource, for tests of every kind.
template <class Resource>
struct Methods;
template <>
struct Methods<v1::Lubricant> {
  static constexpr auto kCreate = create_lubricant;
  static constexpr auto kUpdate = update_lubricant;
  static constexpr auto kDelete = delete_lubricant;
  static constexpr auto kUndelete = undelete_lubricant;
  static constexpr auto kList = list_lubricants;
  static constexpr auto kBatchCreate = batch_create_lubricants;
  static constexpr auto kBatchUpdate = batch_update_lubricants;
  using Create = v1::CreateLubricantRequest;
  using Update = v1::UpdateLubricantRequest;
  using Delete = v1::DeleteLubricantRequest;
  using Undelete = v1::UndeleteLubricantRequest;
  using List = v1::ListLubricantsRequest;
  using BatchCreate = v1::BatchCreateLubricantsRequest;
  using BatchUpdate = v1::BatchUpdateLubricantsRequest;
  static auto* of(auto& request) { return request.mutable_lubricant(); }
  static auto& all(const auto& response) { return response.lubricants(); }
  static constexpr char kCollection[] = "lubricants/";
};
template <>
struct Methods<v1::GearSet> {
  static constexpr auto kCreate = create_gear_set;
  static constexpr auto kUpdate = update_gear_set;
  static constexpr auto kDelete = delete_gear_set;
  static constexpr auto kUndelete = undelete_gear_set;
  static constexpr auto kList = list_gear_sets;
  static constexpr auto kBatchCreate = batch_create_gear_sets;
  static constexpr auto kBatchUpdate = batch_update_gear_sets;
  using Create = v1::CreateGearSetRequest;
  using Update = v1::UpdateGearSetRequest;
  using Delete = v1::DeleteGearSetRequest;
  using Undelete = v1::UndeleteGearSetRequest;
  using List = v1::ListGearSetsRequest;
  using BatchCreate = v1::BatchCreateGearSetsRequest;
  using BatchUpdate = v1::BatchUpdateGearSetsRequest;
  static auto* of(auto& request) { return request.mutable_gear_set(); }
  static auto& all(const auto& response) { return response.gear_sets(); }
  static constexpr char kCollection[] = "gearSets/";
};
template <>
struct Methods<v1::Surface> {
  static constexpr auto kCreate = create_surface;
  static constexpr auto kUpdate = update_surface;
  static constexpr auto kDelete = delete_surface;
  static constexpr auto kUndelete = undelete_surface;
  static constexpr auto kList = list_surfaces;
  static constexpr auto kBatchCreate = batch_create_surfaces;
  static constexpr auto kBatchUpdate = batch_update_surfaces;
  using Create = v1::CreateSurfaceRequest;
  using Update = v1::UpdateSurfaceRequest;
  using Delete = v1::DeleteSurfaceRequest;
  using Undelete = v1::UndeleteSurfaceRequest;
  using List = v1::ListSurfacesRequest;
  using BatchCreate = v1::BatchCreateSurfacesRequest;
  using BatchUpdate = v1::BatchUpdateSurfacesRequest;
  static auto* of(auto& request) { return request.mutable_surface(); }
  static auto& all(const auto& response) { return response.surfaces(); }
  static constexpr char kCollection[] = "surfaces/";
};
template <>
struct Methods<v1::Vehicle> {
  static constexpr auto kCreate = create_vehicle;
  static constexpr auto kUpdate = update_vehicle;
  static constexpr auto kDelete = delete_vehicle;
  static constexpr auto kUndelete = undelete_vehicle;
  static constexpr auto kList = list_vehicles;
  static constexpr auto kBatchCreate = batch_create_vehicles;
  static constexpr auto kBatchUpdate = batch_update_vehicles;
  using Create = v1::CreateVehicleRequest;
  using Update = v1::UpdateVehicleRequest;
  using Delete = v1::DeleteVehicleRequest;
  using Undelete = v1::UndeleteVehicleRequest;
  using List = v1::ListVehiclesRequest;
  using BatchCreate = v1::BatchCreateVehiclesRequest;
  using BatchUpdate = v1::BatchUpdateVehiclesRequest;
  static auto* of(auto& request) { return request.mutable_vehicle(); }
  static auto& all(const auto& response) { return response.vehicles(); }
  static constexpr char kCollection[] = "vehicles/";
};

template <class Resource>
void vary_words(Resource& resource) {
  resource.set_display_name(any_text());
  resource.set_lims_id(any_text());
  // Often a missing one, or a cycle: both are refused.
  const std::string parent =
      Methods<Resource>::kCollection + std::to_string(*rc::gen::inRange(0, 5));
  resource.set_derived_from(
      *rc::gen::element(std::string(), parent, parent, parent + "@1", parent + "@2"));
  resource.clear_labels();
  for (int i = *rc::gen::inRange(0, 3); i > 0; --i) {
    v1::Label* label = resource.add_labels();
    label->set_key("key" + std::to_string(i));
    label->set_value(any_text());
  }
}

/// Returns a lubricant with parameters or with measurements.
v1::Lubricant any_lubricant() {
  v1::Lubricant out;
  if (*rc::gen::arbitrary<bool>()) {
    out = seed<v1::Lubricant>("lubricants/paper-fluid-" + std::to_string(*rc::gen::inRange(1, 4)));
    vary_numbers(out);
  } else {
    auto* measured = out.mutable_measurements();
    measured->set_kinematic_viscosity_100_celsius_square_millimetres_per_second(
        *rc::gen::inRange(4, 40));
    measured->set_kinematic_viscosity_40_celsius_square_millimetres_per_second(
        measured->kinematic_viscosity_100_celsius_square_millimetres_per_second() *
        *rc::gen::inRange(5, 12));
    if (*rc::gen::arbitrary<bool>()) {
      measured->set_density_15_celsius_kilograms_per_cubic_metre(*rc::gen::inRange(820, 1000));
    }
    out.set_base_oil_class(static_cast<v1::Lubricant::BaseOilClass>(*rc::gen::inRange(0, 8)));
  }
  out.set_condition(static_cast<v1::Lubricant::Condition>(*rc::gen::inRange(0, 4)));
  vary_words(out);
  return out;
}

v1::Vehicle any_vehicle() {
  auto out = seed<v1::Vehicle>("vehicles/passenger-car");
  vary_numbers(out);
  vary_words(out);
  return out;
}

v1::Surface any_surface() {
  auto out = seed<v1::Surface>("surfaces/run-in");
  vary_numbers(out);
  vary_words(out);
  return out;
}

v1::GearSet any_gear_set() {
  auto out = seed<v1::GearSet>("gearSets/reference-axle-loaded-error");
  vary_numbers(*out.mutable_dynamics());
  vary_words(out);
  return out;
}

/// Revisions by name; they may only grow.
using Revisions = std::map<std::string, int>;

/// Makes one operation on one of a few names. It must succeed or be refused for a reason that
/// clients can foresee.
template <class Resource>
void operate(Application& app, const Resource& resource, Revisions& revisions) {
  using Kind = Methods<Resource>;
  const std::string name = Kind::kCollection + std::to_string(*rc::gen::inRange(0, 4));
  const auto judge = [&](const auto& outcome) {
    if (!outcome.ok()) {
      const int code = outcome.error().code();
      RC_ASSERT(code == google::rpc::ALREADY_EXISTS || code == google::rpc::NOT_FOUND ||
                code == google::rpc::FAILED_PRECONDITION || code == google::rpc::INVALID_ARGUMENT);
      return;
    }
    int& known = revisions[name];
    RC_ASSERT(outcome.message().revision() >= known);
    RC_ASSERT(outcome.message().revision() <= known + 1);
    known = outcome.message().revision();
  };
  switch (*rc::gen::inRange(0, 5)) {
    case 0:
    case 1: {
      typename Kind::Update request;
      *Kind::of(request) = resource;
      Kind::of(request)->set_name(name);
      request.set_allow_missing(*rc::gen::inRange(0, 4) != 0);
      if (*rc::gen::arbitrary<bool>()) request.mutable_update_mask()->add_paths("display_name");
      return judge(Kind::kUpdate(app, request, {}));
    }
    case 2: {
      typename Kind::Create request;
      *Kind::of(request) = resource;
      Kind::of(request)->set_name(name);
      return judge(Kind::kCreate(app, request, {}));
    }
    case 3: {
      typename Kind::Delete request;
      request.set_name(name);
      return judge(Kind::kDelete(app, request, {}));
    }
    default: {
      typename Kind::Undelete request;
      request.set_name(name);
      return judge(Kind::kUndelete(app, request, {}));
    }
  }
}

/// Updates several names in a batch, which must change all of them or none.
template <class Resource>
void operate_on_several(Application& app, const Resource& resource, Revisions& revisions) {
  using Kind = Methods<Resource>;
  typename Kind::BatchUpdate batch;
  const int first = *rc::gen::inRange(0, 3);
  const int end = *rc::gen::inRange(first + 1, first + 4);
  for (int i = first; i < end; ++i) {
    auto* request = batch.add_requests();
    *Kind::of(*request) = resource;
    Kind::of(*request)->set_name(Kind::kCollection + std::to_string(i));
    request->set_allow_missing(*rc::gen::inRange(0, 8) != 0);
  }
  const auto outcome = Kind::kBatchUpdate(app, batch, {});
  if (!outcome.ok()) {
    const int code = outcome.error().code();
    RC_ASSERT(code == google::rpc::NOT_FOUND || code == google::rpc::FAILED_PRECONDITION ||
              code == google::rpc::INVALID_ARGUMENT);
    return;
  }
  for (const Resource& each : Kind::all(outcome.message())) {
    int& known = revisions[each.name()];
    RC_ASSERT(each.revision() == known || each.revision() == known + 1);
    known = each.revision();
  }
}

std::string without_revision(const std::string& name) { return name.substr(0, name.find('@')); }

/// Returns the exported JSON of all resources that are not deleted, and of those from which they
/// descend, by name.
template <class Resource>
std::map<std::string, std::string> exported(Application& app) {
  std::map<std::string, Resource> all;
  typename Methods<Resource>::List request;
  request.set_page_size(3);
  request.set_show_deleted(true);
  do {
    const auto page = Methods<Resource>::kList(app, request, {});
    RC_ASSERT(page.ok());
    for (const Resource& each : Methods<Resource>::all(page.message())) all[each.name()] = each;
    request.set_page_token(page.message().next_page_token());
  } while (!request.page_token().empty());
  std::map<std::string, std::string> out;
  for (const auto& [name, resource] : all) {
    if (resource.has_delete_time()) continue;
    for (std::string next = name; !next.empty() && out.count(next) == 0;) {
      Resource each = all.at(next);
      keep_client_part(each);
      RC_ASSERT(MessageToJsonString(each, &out[next]).ok());
      next = without_revision(each.derived_from());
    }
  }
  return out;
}

template <class Resource>
void imported(Application& app, const std::map<std::string, std::string>& all) {
  if (all.empty()) return;
  typename Methods<Resource>::BatchCreate batch;
  for (const auto& [name, json] : all) {
    RC_ASSERT(JsonStringToMessage(json, Methods<Resource>::of(*batch.add_requests())).ok());
  }
  const auto outcome = Methods<Resource>::kBatchCreate(app, batch, {});
  if (!outcome.ok()) RC_FAIL(outcome.error().message());
}

template <class Resource>
void expect_same_again(Application& from, Application& to) {
  const auto first = exported<Resource>(from);
  imported<Resource>(to, first);
  RC_ASSERT(exported<Resource>(to) == first);
}

/// Creates a simulation with one of the existing lubricants.
void simulate(Application& app) {
  v1::CreateSimulationRequest request;
  *request.mutable_simulation() = point_simulation();
  request.mutable_simulation()->set_lubricant("lubricants/paper-fluid-" +
                                              std::to_string(*rc::gen::inRange(0, 4)));
  const auto outcome = create_simulation(app, request);
  if (!outcome.ok()) RC_ASSERT(outcome.error().code() == google::rpc::INVALID_ARGUMENT);
}

RC_GTEST_PROP(AnySequenceOfOperations, KeepsTheStoreConsistentAndItsExportExact, ()) {
  Place place;
  Revisions revisions;
  place.store.add_project("default", seed_resources(), system_time());
  for (const NewResource& seed : seed_resources()) revisions[seed.name] = 1;
  for (int i = *rc::gen::inRange(1, 25); i > 0; --i) {
    switch (*rc::gen::inRange(0, 9)) {
      case 4:
        operate_on_several(place.app, any_vehicle(), revisions);
        break;
      case 5:
        operate_on_several(place.app, any_lubricant(), revisions);
        break;
      case 3:
        simulate(place.app);
        break;
      case 0:
        operate(place.app, any_vehicle(), revisions);
        break;
      case 1:
        operate(place.app, any_surface(), revisions);
        break;
      case 2:
        operate(place.app, any_gear_set(), revisions);
        break;
      default:
        operate(place.app, any_lubricant(), revisions);
    }
  }
  place.jobs.stop();
  RC_ASSERT(check_database(place.folder.file("tribodyn.db")).empty());
  int accepted = -static_cast<int>(seed_resources().size());
  for (const auto& [name, revision] : revisions) {
    accepted += revision;
    RC_ASSERT(place.store.revisions(name, 0, 1000, 1 << 30).rows.size() ==
              static_cast<std::size_t>(revision));
  }
  RC_CLASSIFY(accepted >= 5, "five revisions or more");
  Place other;
  expect_same_again<v1::Lubricant>(place.app, other.app);
  expect_same_again<v1::GearSet>(place.app, other.app);
  expect_same_again<v1::Surface>(place.app, other.app);
  expect_same_again<v1::Vehicle>(place.app, other.app);
  RC_ASSERT(check_database(other.folder.file("tribodyn.db")).empty());
}

}  // namespace
}  // namespace tribodyn::server
