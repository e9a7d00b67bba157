#pragma once

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/outcome.h"
#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/surfaces.pb.h"

namespace tribodyn::server {

// These use cases create a resource from tables that a client sends as text. A refused table
// changes nothing.

Outcome<v1::Lubricant> import_lubricant(Application& application,
                                        const v1::ImportLubricantRequest& request,
                                        const CallContext& call = {});
Outcome<v1::GearSet> import_gear_set(Application& application,
                                     const v1::ImportGearSetRequest& request,
                                     const CallContext& call = {});
Outcome<v1::Surface> import_surface_profiles(Application& application,
                                             const v1::ImportSurfaceProfilesRequest& request,
                                             const CallContext& call = {});

}  // namespace tribodyn::server
