#pragma once

#include <string>

#include "server/contract/resource_names.h"
#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/surfaces.pb.h"
#include "tribodyn/v1/vehicles.pb.h"

namespace tribodyn::server {

/// What the standard methods need to know of a kind of resource: its collection, the field that
/// holds it in requests, the fields that bear its name, and its lists in responses.
template <class Resource>
struct Kind;

template <>
struct Kind<v1::Lubricant> {
  static constexpr char kCollection[] = "lubricants";
  static constexpr char kField[] = "lubricant";
  static const v1::Lubricant& of(const auto& request) { return request.lubricant(); }
  static bool is_in(const auto& request) { return request.has_lubricant(); }
  static const std::string& id(const auto& request) { return request.lubricant_id(); }
  static v1::Lubricant* add(auto& response) { return response.add_lubricants(); }
  static auto* all(auto& response) { return response.mutable_lubricants(); }
};

template <>
struct Kind<v1::GearSet> {
  static constexpr char kCollection[] = "gearSets";
  static constexpr char kField[] = "gear_set";
  static const v1::GearSet& of(const auto& request) { return request.gear_set(); }
  static bool is_in(const auto& request) { return request.has_gear_set(); }
  static const std::string& id(const auto& request) { return request.gear_set_id(); }
  static v1::GearSet* add(auto& response) { return response.add_gear_sets(); }
  static auto* all(auto& response) { return response.mutable_gear_sets(); }
};

template <>
struct Kind<v1::Surface> {
  static constexpr char kCollection[] = "surfaces";
  static constexpr char kField[] = "surface";
  static const v1::Surface& of(const auto& request) { return request.surface(); }
  static bool is_in(const auto& request) { return request.has_surface(); }
  static const std::string& id(const auto& request) { return request.surface_id(); }
  static v1::Surface* add(auto& response) { return response.add_surfaces(); }
  static auto* all(auto& response) { return response.mutable_surfaces(); }
};

template <>
struct Kind<v1::Vehicle> {
  static constexpr char kCollection[] = "vehicles";
  static constexpr char kField[] = "vehicle";
  static const v1::Vehicle& of(const auto& request) { return request.vehicle(); }
  static bool is_in(const auto& request) { return request.has_vehicle(); }
  static const std::string& id(const auto& request) { return request.vehicle_id(); }
  static v1::Vehicle* add(auto& response) { return response.add_vehicles(); }
  static auto* all(auto& response) { return response.mutable_vehicles(); }
};

}  // namespace tribodyn::server
