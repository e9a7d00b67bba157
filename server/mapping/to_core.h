#pragma once

#include "core/celsius.h"
#include "core/contact/flank_contact.h"
#include "core/gear/gear_set.h"
#include "core/laws/lubricant.h"
#include "core/model_options.h"
#include "core/study/figure_limits.h"
#include "core/surface/surface.h"
#include "core/vehicle/vehicle.h"
#include "tribodyn/v1/contacts.pb.h"
#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/model_options.pb.h"
#include "tribodyn/v1/simulations.pb.h"
#include "tribodyn/v1/surfaces.pb.h"
#include "tribodyn/v1/vehicles.pb.h"

namespace tribodyn::server {

// These functions convert messages to core values field by field. They check nothing: see
// check_message.h.
Lubricant to_core(const v1::Lubricant& message);
LubricantBoundary lubricant_boundary(const v1::Lubricant& message);

/// Makes the lubricant that of a scene: core's Scene or RigScene.
template <class AnyScene>
void set_lubricant(const v1::Lubricant& message, AnyScene& scene) {
  scene.lubricant = to_core(message);
  scene.lubricant_boundary = lubricant_boundary(message);
}

// The fields of these have the same names in resources and in an explicit contact.
template <class Message>  // v1::Surface or v1::EvaluateContactRequest
Roughness roughness(const Message& message);
template <class Message>  // v1::Surface or v1::EvaluateContactRequest
BoundaryFriction boundary_friction(const Message& message);
template <class Message>  // v1::GearSet or v1::EvaluateContactRequest
Solid solid(const Message& message);

Vehicle to_core(const v1::Vehicle& message);
ModelOptions to_core(const v1::ModelOptions& message);
StatedLimits to_core(const v1::StatedLimits& message);

/// Converts the first three slots only; the core's check() refuses any other number.
GearSet to_core(const v1::GearSet& message);

ContactConditions contact_conditions(const v1::EvaluateContactRequest& message);

}  // namespace tribodyn::server
