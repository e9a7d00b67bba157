#include "server/contract/resource_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "server/contract/constraints.h"
#include "server/support/text.h"

namespace tribodyn::server {
namespace {

bool is_id_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_' || c == '.';
}

/// Levenshtein distance from a to b, and the smallest distance from a to any prefix of b.
struct EditDistances {
  std::size_t to_whole = 0;
  std::size_t to_prefix = 0;
};

EditDistances edit_distances(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return {row.back(), *std::min_element(row.begin(), row.end())};
}

/// Returns the part after "lubricants/". Names are compared without their collection.
std::string_view id_of(std::string_view name) { return name.substr(name.find('/') + 1); }

/// Whether a text is a name in a project or in a collection, e.g. "surfaces/run-in".
bool is_in_collection(std::string_view text) {
  constexpr std::string_view kCollections[] = {kProjects, kLubricants,  kGearSets, kSurfaces,
                                               kVehicles, kSimulations, kCampaigns};
  const std::string_view first = text.substr(0, text.find('/'));
  return first.size() < text.size() && std::find(std::begin(kCollections), std::end(kCollections),
                                                 first) != std::end(kCollections);
}

/// Returns the number in "collection/{id}", or nullopt if `name` has another form.
std::optional<std::int64_t> number_in(std::string_view name, std::string_view collection) {
  if (!is_resource_name(name, collection)) return std::nullopt;
  const auto number = parse_number<std::int64_t>(name.substr(collection.size() + 1));
  return number && *number > 0 ? number : std::nullopt;
}

}  // namespace

bool is_project_id(std::string_view id) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  constexpr std::size_t kLongestProjectId = 63;
  return !id.empty() && id.size() <= kLongestProjectId && is_letter(id.front()) &&
         id.back() != '-' && std::all_of(id.begin(), id.end(), [&](char c) {
           return is_letter(c) || is_digit(c) || c == '-';
         });
}

std::optional<ProjectAndName> split_name(std::string_view name) {
  constexpr std::string_view kPrefix = "projects/";
  if (!name.starts_with(kPrefix)) return ProjectAndName{kDefaultProject, name};
  const std::string_view rest = name.substr(kPrefix.size());
  const std::string_view project = rest.substr(0, rest.find('/'));
  if (!is_project_id(project)) return std::nullopt;
  return ProjectAndName{project, rest.substr(std::min(rest.size(), project.size() + 1))};
}

std::string full_name(std::string_view project, std::string_view relative) {
  if (project == kDefaultProject) return std::string(relative);
  return fmt::format("{}/{}/{}", kProjects, project, relative);
}

std::string name_in(std::string_view project, std::string_view name) {
  if (!name.starts_with("projects/")) return full_name(project, name);
  const auto parts = split_name(name);
  return parts ? full_name(parts->project, parts->relative) : std::string(name);
}

std::string relative_name(std::string_view name) {
  const auto parts = split_name(name);
  return std::string(parts ? parts->relative : name);
}

std::string plain_excerpt(std::string_view text) {
  std::string out(text.substr(0, 60));
  for (char& c : out) {
    if (c < ' ' || c > '~') c = '?';
  }
  return text.size() > 60 ? out + "..." : out;
}

bool is_resource_name(std::string_view name, std::string_view collection) {
  if (name.size() > static_cast<std::size_t>(kMaximumTextLength)) return false;
  if (name.size() < collection.size() + 2 || name.substr(0, collection.size()) != collection ||
      name[collection.size()] != '/') {
    return false;
  }
  const std::string_view id = name.substr(collection.size() + 1);
  return std::all_of(id.begin(), id.end(), is_id_character);
}

std::string allowed_id(std::string_view text) {
  std::string out;
  if (is_in_collection(text)) return out;
  for (const char c : text.substr(0, kMaximumTextLength)) {
    if (is_id_character(c)) {
      out += c;
    } else if (!out.empty() && out.back() != '-') {
      out += '-';
    }
  }
  while (!out.empty() && out.back() == '-') out.pop_back();
  return out;
}

std::optional<RevisionName> parse_revision_name(std::string_view name,
                                                std::string_view collection) {
  const std::size_t at = name.find('@');
  if (!is_resource_name(name.substr(0, at), collection)) return std::nullopt;
  RevisionName out{std::string(name.substr(0, at)), 0};
  if (at == std::string_view::npos) return out;
  const std::string_view digits = name.substr(at + 1);
  out.revision = parse_number<int>(digits).value_or(0);
  const bool is_canonical = std::to_string(out.revision) == digits;
  return is_canonical && out.revision >= 1 ? std::optional(out) : std::nullopt;
}

std::string revision_name(std::string_view name, int revision) {
  return fmt::format("{}@{}", name, revision);
}

std::string deleted_name_text(std::string_view name) {
  return fmt::format("\"{}\" is deleted; undelete it to use it", plain_excerpt(name));
}

std::optional<std::int64_t> simulation_id(std::string_view name) {
  return number_in(name, kSimulations);
}

std::string simulation_name(std::string_view project, std::int64_t number) {
  return full_name(project, fmt::format("{}/{}", kSimulations, number));
}

std::optional<std::int64_t> campaign_id(std::string_view name) {
  return number_in(name, kCampaigns);
}

std::string campaign_name(std::string_view project, std::int64_t number) {
  return full_name(project, fmt::format("{}/{}", kCampaigns, number));
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& existing) {
  const std::string_view compared = id_of(name).substr(0, kMaximumTextLength);
  if (compared.empty()) return {};
  // At most half of the letters: any two short names are near each other.
  const std::size_t largest_distance =
      std::min(std::max<std::size_t>(2, compared.size() / 3), compared.size() / 2);
  // 0 below four letters: a prefix of any name is near a short text
  const std::size_t largest_prefix_distance = compared.size() / 4;
  std::string nearest;
  std::size_t smallest_distance = largest_distance + 1;
  for (const std::string& each : existing) {
    const EditDistances found = edit_distances(compared, id_of(each));
    std::size_t count = found.to_whole;
    if (id_of(each).starts_with(compared)) count = 0;
    if (found.to_prefix <= largest_prefix_distance) count = std::min(count, found.to_prefix + 1);
    if (count >= smallest_distance) continue;
    smallest_distance = count;
    nearest = each;
  }
  return nearest;
}

std::string meant_text(std::string_view name, const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(name, known);
  if (!nearest.empty()) return fmt::format("; did you mean \"{}\"?", nearest);
  return fmt::format("; allowed: {}", fmt::join(known, ", "));
}

std::string unknown_name_text(std::string_view name, std::string_view collection,
                              const std::vector<std::string>& existing) {
  const bool is_name = parse_revision_name(name, collection).has_value();
  const std::string own = std::string(collection) + "/";
  const std::string_view head = name.substr(0, name.find('/'));
  // "lubricant/x", but not "75W/90": a misspelt collection.
  const bool has_head = head.size() < name.size() &&
                        edit_distances(head, collection).to_whole <= collection.size() / 3;
  const std::string nearest =
      nearest_name(own + allowed_id(has_head ? name.substr(head.size() + 1) : name), existing);
  std::string hint = nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest);
  if (is_name) return fmt::format("\"{}\" does not exist{}", plain_excerpt(name), hint);
  const std::string id = allowed_id(name);
  if (hint.empty() && !id.empty()) hint = fmt::format("; \"{}{}\" is one", own, id);
  return fmt::format("\"{}\" is not a name of the form \"{}/{{id}}\"{}", plain_excerpt(name),
                     collection, hint);
}

}  // namespace tribodyn::server
