#pragma once

#include <string>
#include <vector>

#include "client/cpp/resources/kind.h"
#include "client/cpp/text/output.h"

namespace tribodyn::client {

/// One resource for a person: what it is, for a lubricant its viscosities, index and grade with
/// how well the laws fit, every parameter with unit, uncertainty and how it is known, and what to
/// know before relying on it.
std::string resource_sheet(const google::protobuf::Message& resource);

/// Several in a table, a line each. `as_revisions`: of one resource, newest first.
std::string resource_table(const ResourceKind& kind, const std::vector<ResourcePointer>& resources,
                           bool as_revisions);

/// One resource in any format.
std::string resource_text(const google::protobuf::Message& resource, OutputFormat format);
/// Several: a table, CSV with every number, or JSON as the server's list response has it.
std::string resources_text(const ResourceKind& kind, const std::vector<ResourcePointer>& resources,
                           OutputFormat format, bool as_revisions);

/// JSON without what only the server sets: what import reads. One resource, or an object with a
/// list.
std::string export_text(const ResourceKind& kind, const std::vector<ResourcePointer>& resources);

/// How one parameter of a resource is known; null when nothing is stated.
const v1::ParameterProvenance* provenance_of(const google::protobuf::Message& resource,
                                             const std::string& field);

/// The characterisation's figures, warnings and fits, for a lubricant.
std::string characterisation_sheet(const v1::Lubricant& lubricant);
/// The warnings alone, a line or more each; empty when there are none.
std::string characterisation_warnings(const v1::Lubricant& lubricant);

}  // namespace tribodyn::client
