#pragma once

#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/surfaces.pb.h"
#include "tribodyn/v1/vehicles.pb.h"

/// The kinds of resources that are kept in revisions, with the same methods under other names. ROW
/// is a macro with four arguments: the message; the field that holds it in requests, a field with
/// an "s" holding several; the collection, the first part of names; the id of a seed.
/// server/README.md lists what a further row needs.
#define TRIBODYN_RESOURCE_KINDS(ROW)                     \
  ROW(Lubricant, lubricant, lubricants, "paper-fluid-1") \
  ROW(GearSet, gear_set, gearSets, "reference-axle")     \
  ROW(Surface, surface, surfaces, "run-in")              \
  ROW(Vehicle, vehicle, vehicles, "passenger-car")
