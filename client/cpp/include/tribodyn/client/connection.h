#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include "tribodyn/client/error.h"
#include "tribodyn/v1/campaigns.pb.h"
#include "tribodyn/v1/contacts.pb.h"
#include "tribodyn/v1/cycles.pb.h"
#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/points.pb.h"
#include "tribodyn/v1/profiles.pb.h"
#include "tribodyn/v1/purge_report.pb.h"
#include "tribodyn/v1/rigs.pb.h"
#include "tribodyn/v1/schemas.pb.h"
#include "tribodyn/v1/simulations.pb.h"
#include "tribodyn/v1/spectra.pb.h"
#include "tribodyn/v1/surfaces.pb.h"
#include "tribodyn/v1/vehicles.pb.h"
#include "tribodyn/v1/viscosities.pb.h"

namespace tribodyn::client {

inline constexpr char kDefaultServer[] = "127.0.0.1:50651";
inline constexpr char kDefaultProject[] = "default";
inline constexpr char kServerVariable[] = "TRIBODYN_SERVER";

/// Returns the address of the server: `address` unless it is empty, else the environment variable
/// TRIBODYN_SERVER, else the Unix socket of the user's own server if there is one, else
/// 127.0.0.1:50651. "unix:PATH" is a Unix socket.
std::string server_address(const std::string& address = "");

/// Files that show the server who calls, and say which servers to trust.
struct AccessFiles {
  std::string token = {};        ///< its first word goes with every call; empty: none
  std::string authorities = {};  ///< PEM: who signs servers' certificates; empty: the system's list
  std::string certificate = {};  ///< PEM: of the client, for servers that require one
  std::string key = {};          ///< PEM: private key of the certificate
};

/// Returns `files` with those of the environment in place of the empty ones: TRIBODYN_TOKEN_FILE,
/// TRIBODYN_CA_FILE, TRIBODYN_CERTIFICATE_FILE, TRIBODYN_KEY_FILE.
AccessFiles access_files(AccessFiles files = {});

/// Which resources to list, and in which order.
struct ListOptions {
  /// AIP-160: restrictions joined by AND, e.g. `labels.project = "axle" AND condition = SHEARED`.
  std::string filter = {};
  std::string order_by = {};  ///< "name" or a field of the filter; " desc" reverses it
  bool show_deleted = false;  ///< list deleted resources too
  int limit = 0;              ///< at most this many; 0: all
  /// Listing::next_page_token of the previous page, with the same filter and order.
  std::string page_token = {};
  bool basic = false;  ///< gear sets without their tables
};

/// Resources from as many pages as the call read.
template <class Resource>
struct Listing {
  std::vector<Resource> resources;
  bool has_more = false;  ///< `limit` was reached and more exist
  int total_size = 0;     ///< of the whole list when its first page was read; -1: not counted
  std::string next_page_token = {};  ///< token of the next page; empty if there is none
};

/// One resource of a batch of updates.
template <class Resource>
struct ResourceUpdate {
  Resource resource;
  std::vector<std::string> update_mask;  ///< as in UpdateOptions
};

/// Options of a batch.
struct BatchOptions {
  bool validate_only = false;  ///< check everything, write nothing
  bool allow_missing = false;  ///< of updates: create those that are not there
  /// Fields of the resources to return, e.g. {"name", "etag"}; empty: all. An answer takes at most
  /// 4 MB: a batch whose answer would take more is refused, and nothing is written.
  std::vector<std::string> read_mask = {};
};

/// Options of an update.
struct UpdateOptions {
  /// Fields that the update sets. Empty: the fields that the resource populates; the others stay.
  /// {"*"}: all fields (a full replacement).
  std::vector<std::string> update_mask = {};
  bool allow_missing = false;  ///< create the resource if it does not exist
  bool validate_only = false;  ///< check everything, write nothing
};

/// Options of a new simulation.
struct CreateOptions {
  bool validate_only = false;  ///< check everything, run nothing
  bool force = false;          ///< compute even if equal inputs have a result
  /// How soon the simulation begins among those that wait.
  v1::SchedulingClass scheduling_class = v1::SCHEDULING_CLASS_UNSPECIFIED;
  std::string request_id =
      {};  ///< a repeated request with the same id starts no second simulation; empty: random
};

/// Options of a new campaign.
struct CreateCampaignOptions {
  bool validate_only = false;  ///< check everything, run nothing
  /// A repeated request with the same id returns the campaign of the first one; empty: random.
  std::string request_id = {};
};

/// Options of the deletion of a simulation.
struct DeleteOptions {
  bool cancel = false;         ///< cancel it first if it has not ended
  bool allow_missing = false;  ///< succeed if it does not exist
  std::string etag = {};       ///< refused unless this is the present one; empty: any
};

/// Options of a purge.
struct PurgeOptions {
  bool delete_simulations = false;  ///< delete every simulation that used the resource too
  bool allow_missing = false;       ///< succeed if it does not exist
  bool validate_only = false;       ///< count what would be erased, and erase nothing
  std::string etag = {};            ///< refused unless this is the present one; empty: any
};

/// The part of a history to read.
struct HistoryOptions {
  std::vector<std::string> columns = {};  ///< empty: all
  std::int64_t start_row = 0;
  std::int64_t row_count = 0;  ///< 0: to the end
  int maximum_points = 0;      ///< 0: all rows; else an overview where there are more
};

/// Most candidates of a campaign.
inline constexpr int kMostCandidates = 100'000;

/// Most points of one call of evaluate_points().
inline constexpr int kMostPointsOfACall = 2000;

/// The part of a campaign to read.
struct CampaignRowsOptions {
  std::vector<std::string> columns = {};  ///< empty: refusal_number and all figures
  std::int64_t start_row = 0;
  std::int64_t row_count = 0;  ///< 0: to the end
  /// Only rows that satisfy all conditions, e.g. "refusal_number > 0" or "film_ratio_minimum < 1
  /// AND additive = ZDDP". HistoryRows::first_row then counts these rows alone; the column "row"
  /// has their numbers.
  std::string filter = {};
};

/// Consecutive rows: for each column of the schema its values, equally many.
struct HistoryRows {
  std::int64_t first_row = 0;  ///< 0 is the first requested row
  std::vector<std::vector<double>> columns;
};

/// A server, its services and a project. Names without a project mean resources of this project,
/// and names of its resources are answered without it. Safe for concurrent use. The constructor
/// sends nothing. Every call throws ServiceError if it fails. A call retries within the time limit,
/// where that is safe, when the server is lost or turns the request away. `Resource` is
/// v1::Lubricant, v1::GearSet, v1::Surface or v1::Vehicle.
class Connection {
 public:
  /// `timeout` limits every call except watch(), wait_for_end(), follow_campaign() and the reading
  /// of histories and campaigns.
  /// A Unix socket needs no token. The connection uses TLS unless the address is loopback or a Unix
  /// socket, and always if `access.authorities` is set. Throws std::invalid_argument if a file
  /// cannot be read.
  explicit Connection(std::string address,
                      std::chrono::duration<double> timeout = std::chrono::seconds(30),
                      std::string project = kDefaultProject,
                      const AccessFiles& access = access_files());
  ~Connection();
  Connection(Connection&& other) noexcept;
  Connection& operator=(Connection&& other) noexcept;

  const std::string& address() const;
  const std::string& project() const;
  /// Has `report` called, on the thread of the call, with the server's sentence once a call has
  /// waited for some seconds because a quota is spent.
  void report_waits(std::function<void(const std::string&)> report);

  /// Creates a resource under `id` (empty: the id in its name) and returns it as stored: with
  /// fitted and estimated parameters and the provenance of each.
  template <class Resource>
  Resource create(const Resource& resource, const std::string& id, bool validate_only = false);
  /// Returns the newest revision of "lubricants/{id}", or the revision
  /// "lubricants/{id}@{revision}".
  template <class Resource>
  Resource get(const std::string& name);
  template <class Resource>
  Listing<Resource> list(const ListOptions& options = {});
  /// Creates a new revision of the resource of that name, or none if nothing changes. Fails with
  /// ABORTED if `resource` has an etag that is not the current one.
  template <class Resource>
  Resource update(const Resource& resource, const UpdateOptions& options = {});
  // A batch writes all of its resources or none. One of them may be derived from another, in any
  // order.
  /// Creates resources under the ids in their names and returns them in their order.
  template <class Resource>
  std::vector<Resource> create_all(const std::vector<Resource>& resources,
                                   const BatchOptions& options = {});
  /// Updates each resource as update() does and returns them in their order.
  template <class Resource>
  std::vector<Resource> update_all(const std::vector<ResourceUpdate<Resource>>& updates,
                                   const BatchOptions& options = {});
  /// Returns the revisions, newest first; limit 0: all.
  template <class Resource>
  Listing<Resource> revisions(const std::string& name, int limit = 0);
  /// Deletes a resource: lists and new simulations do not find it any more. undelete() restores it.
  template <class Resource>
  Resource remove(const std::string& name, const std::string& etag = "");
  template <class Resource>
  Resource undelete(const std::string& name, const std::string& etag = "");

  /// Erases a resource with all its revisions for good.
  template <class Resource>
  v1::PurgeReport purge(const std::string& name, const PurgeOptions& options = {});

  // Create resources from tables of numbers as CSV texts; the requests describe the columns.
  v1::Lubricant import_lubricant(const v1::ImportLubricantRequest& request);
  v1::GearSet import_gear_set(const v1::ImportGearSetRequest& request);
  v1::Surface import_surface_profiles(const v1::ImportSurfaceProfilesRequest& request);

  /// Returns the constraints of one message, e.g. "Lubricant", or of all messages.
  v1::Schema schema(const std::string& message = "");

  /// Returns before the simulation has run. Retries under the same request_id if the server is lost
  /// meanwhile.
  v1::Simulation create_simulation(const v1::Simulation& simulation,
                                   const CreateOptions& options = {});
  v1::Simulation get_simulation(const std::string& name);
  v1::Simulation cancel_simulation(const std::string& name);
  /// Removes a simulation for good, with its result unless another simulation shares that.
  void delete_simulation(const std::string& name, const DeleteOptions& options = {});
  /// Lists simulations without results, newest first unless options.order_by is set. Filters as in
  /// ListSimulationsRequest.
  Listing<v1::Simulation> list_simulations(const ListOptions& options = {});
  /// Pin or unpin a simulation: a pinned one neither expires nor is evicted.
  v1::Simulation pin_simulation(const std::string& name);
  v1::Simulation unpin_simulation(const std::string& name);
  /// Blocks until all simulations have ended or are deleted, or until `stop` is requested. Calls
  /// `on_event` in the calling thread for each change of state, once and in order, and for
  /// progress. Resumes a broken stream after the last event, for a limited time. Of more than 1000
  /// simulations it watches 1000 at a time, and of several projects one after the other.
  void watch(const std::vector<std::string>& names,
             const std::function<void(const v1::SimulationEvent&)>& on_event = {},
             const std::stop_token& stop = {});
  /// Watches one simulation and returns it with its result; in its current state when `stop` is
  /// requested.
  v1::Simulation wait_for_end(const std::string& name,
                              const std::function<void(const v1::SimulationEvent&)>& on_event = {},
                              const std::stop_token& stop = {});
  /// Returns a history, or an overview of it, in one message.
  v1::History read_history(const std::string& name, const HistoryOptions& options = {});
  /// Calls `on_rows` in the calling thread for rows as they arrive, once and in order. Resumes a
  /// broken stream at the first missing row, for a limited time.
  void stream_history(const std::string& name, const HistoryOptions& options,
                      const std::function<void(const v1::HistorySchema&)>& on_schema,
                      const std::function<void(const HistoryRows&)>& on_rows);

  /// Returns before the campaign has run. Retries under the same request_id if the server is lost
  /// meanwhile.
  v1::Campaign create_campaign(const v1::Campaign& campaign,
                               const CreateCampaignOptions& options = {});
  v1::Campaign get_campaign(const std::string& name,
                            v1::CampaignView view = v1::CAMPAIGN_VIEW_BASIC);
  /// Lists campaigns, newest first; of the options it takes filter, limit and page_token.
  Listing<v1::Campaign> list_campaigns(const ListOptions& options = {});
  /// Changes the display name or the labels of a campaign, whatever its state. `update_mask`:
  /// "display_name", "labels"; empty: those of the two that the campaign populates; {"*"}: both.
  v1::Campaign update_campaign(const v1::Campaign& campaign,
                               const std::vector<std::string>& update_mask = {});
  /// Adds candidates to a campaign. A request without a request_id gets a random one, so that the
  /// call adds them once even if the server is lost meanwhile.
  v1::Campaign append_candidates(v1::AppendCandidatesRequest request);
  v1::Campaign pause_campaign(const std::string& name);
  /// Resumes a campaign that is paused, and sets its budget if there is one here.
  v1::Campaign resume_campaign(const std::string& name,
                               const std::optional<v1::CampaignBudget>& budget = {});
  v1::Campaign cancel_campaign(const std::string& name);
  /// Removes a campaign for good, with its rows; of the options it takes cancel and allow_missing.
  void delete_campaign(const std::string& name, const DeleteOptions& options = {});
  /// Blocks until the campaign has ended or is paused, or until `stop` is requested, and returns
  /// it. Gets it up to 100 times a second at first, later twice a second, and calls `on_progress`
  /// in the calling thread after each time. Waits for a server that is lost, for a limited time.
  v1::Campaign follow_campaign(const std::string& name,
                               const std::function<void(const v1::Campaign&)>& on_progress = {},
                               const std::stop_token& stop = {});
  /// Calls `on_rows` in the calling thread for rows as they arrive, once and in order. Rows that
  /// are not computed yet are NaN, and -1 in refusal_number. Resumes a broken stream at the first
  /// missing row, for a limited time; one with a filter fails.
  void stream_campaign(const std::string& name, const CampaignRowsOptions& options,
                       const std::function<void(const v1::HistorySchema&)>& on_schema,
                       const std::function<void(const HistoryRows&)>& on_rows);

  /// Returns the `count` best candidates of a campaign and marks those that tie with the best one.
  /// kMostCandidates means all. Makes a call for each 10,000. Throws ServiceError RANKING_CHANGED
  /// if candidates are added or computed between two of these calls.
  v1::RankCandidatesResponse rank_candidates(const v1::RankCandidatesRequest& request);
  /// Returns the candidates that no other one beats in both of two objectives.
  v1::FindParetoCandidatesResponse find_pareto_candidates(
      const v1::FindParetoCandidatesRequest& request);
  /// Returns the effects of columns of candidates on a figure.
  v1::EstimateCandidateEffectsResponse estimate_candidate_effects(
      const v1::EstimateCandidateEffectsRequest& request);
  /// Makes a candidate a lubricant and a surface.
  v1::PromoteCandidateResponse promote_candidate(const v1::PromoteCandidateRequest& request);

  v1::EvaluateContactResponse evaluate_contact(const v1::EvaluateContactRequest& request);

  /// Adds up the mesh loss of lubricants over a drive cycle and stores nothing.
  v1::EvaluateCycleResponse evaluate_cycle(const v1::EvaluateCycleRequest& request);
  /// Returns the surface that measured profiles make, by their sampling interval.
  v1::EvaluateProfilesResponse evaluate_profiles(const v1::EvaluateProfilesRequest& request);

  v1::EvaluateRigResponse evaluate_rig(const v1::EvaluateRigRequest& request);
  /// Evaluates the viscosity of a lubricant over temperature and pressure.
  v1::EvaluateViscosityResponse evaluate_viscosity(const v1::EvaluateViscosityRequest& request);
  /// Returns order spectra of the history of a simulation.
  v1::ReadSpectrumResponse read_spectrum(const v1::ReadSpectrumRequest& request);
  /// Evaluates up to 2000 points of candidates and stores nothing.
  v1::EvaluatePointsResponse evaluate_points(const v1::EvaluatePointsRequest& request);
  /// Compares lubricants at conditions with the uncertainty of their inputs.
  v1::ComparePointsResponse compare_points(const v1::ComparePointsRequest& request);
  /// Attributes the difference of two lubricants to groups of parameters.
  v1::ExplainPointsResponse explain_points(const v1::ExplainPointsRequest& request);

 private:
  struct Services;
  /// `open` are relative names of at most 1000 simulations of the project.
  void watch_some(const std::string& project, std::set<std::string> open,
                  const std::function<void(const v1::SimulationEvent&)>& on_event,
                  const std::stop_token& stop);

  std::unique_ptr<Services> services_;
};

/// Whether the state is final: succeeded, failed or cancelled.
bool has_ended(v1::Simulation::State state);
bool has_ended(v1::Campaign::State state);

}  // namespace tribodyn::client
