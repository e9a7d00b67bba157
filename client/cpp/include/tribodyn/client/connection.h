#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "tribodyn/client/error.h"
#include "tribodyn/v1/batches.pb.h"
#include "tribodyn/v1/contacts.pb.h"
#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/schemas.pb.h"
#include "tribodyn/v1/simulations.pb.h"
#include "tribodyn/v1/surfaces.pb.h"
#include "tribodyn/v1/vehicles.pb.h"

namespace tribodyn::client {

inline constexpr char kDefaultServer[] = "127.0.0.1:50651";
inline constexpr char kServerVariable[] = "TRIBODYN_SERVER";

/// The address to use: `address` unless empty, else the environment variable TRIBODYN_SERVER, else
/// 127.0.0.1:50651. "unix:PATH" is a socket.
std::string server_address(const std::string& address = "");

/// Which resources to list, and in which order.
struct ListOptions {
  /// AIP-160: restrictions joined by AND, e.g. `labels.project = "axle" AND condition = SHEARED`.
  std::string filter = {};
  std::string order_by = {};  ///< "name", or a field of the filter; " desc" turns it round
  bool show_deleted = false;  ///< also those that were deleted
  int limit = 0;              ///< at most so many; 0: all
  /// To go on where a list ended: its Listing::next_page_token, with the same filter and order.
  std::string page_token = {};
  bool basic = false;  ///< gear sets without their tables
};

/// Resources, over as many pages as it took.
template <class Resource>
struct Listing {
  std::vector<Resource> resources;
  bool has_more = false;             ///< `limit` ended it
  std::string next_page_token = {};  ///< where it did; empty: there are no more
};

/// A resource of a batch of updates.
template <class Resource>
struct ResourceUpdate {
  Resource resource;
  std::vector<std::string> update_mask;  ///< as in UpdateOptions
};

/// What a batch wrote, in the order of what was sent.
template <class Resource>
struct BatchResult {
  std::vector<v1::WrittenResource> written;
  /// Empty if `written` is not: together they take more than 2 MB, and get() or list() has them.
  std::vector<Resource> resources;
};

/// How an update is made.
struct UpdateOptions {
  /// Fields to take over. Empty: those that the resource populates; all others stay. {"*"}: all, a
  /// full replacement.
  std::vector<std::string> update_mask = {};
  bool allow_missing = false;  ///< create it if there is none
  bool validate_only = false;  ///< check everything, write nothing
};

/// How a simulation is created.
struct CreateOptions {
  bool validate_only = false;   ///< check everything, run nothing
  bool force = false;           ///< compute although equal inputs have a result
  std::string request_id = {};  ///< so that a repeated request makes no second one; empty: random
};

/// Which part of a history is read.
struct HistoryOptions {
  std::vector<std::string> columns = {};  ///< empty: all
  std::int64_t start_row = 0;
  std::int64_t row_count = 0;  ///< 0: to the end
  int maximum_points = 0;      ///< 0: all rows; else an overview where there are more
};

/// A run of rows: values of each column of the schema, all as many.
struct HistoryRows {
  std::int64_t first_row = 0;  ///< counted from the first one asked for
  std::vector<std::vector<double>> columns;
};

/// A server and its services. Safe for concurrent use. Nothing is sent before the first call; every
/// call throws ServiceError, at last: where that is safe, a server that is lost or turns a request
/// away is asked again within the time limit. `Resource` is v1::Lubricant, v1::GearSet, v1::Surface
/// or v1::Vehicle.
class Connection {
 public:
  /// `timeout` bounds every call but wait_for_end() and the reading of histories.
  explicit Connection(std::string address,
                      std::chrono::duration<double> timeout = std::chrono::seconds(30));
  ~Connection();
  Connection(Connection&& other) noexcept;
  Connection& operator=(Connection&& other) noexcept;

  const std::string& address() const;

  /// Adds a resource under `id` (empty: the id in its name) and returns it as the server keeps it:
  /// with what was fitted and estimated, each parameter with its provenance.
  template <class Resource>
  Resource create(const Resource& resource, const std::string& id, bool validate_only = false);
  /// "lubricants/{id}" for the newest revision, "lubricants/{id}@{revision}" for another one.
  template <class Resource>
  Resource get(const std::string& name);
  template <class Resource>
  Listing<Resource> list(const ListOptions& options = {});
  /// Makes a new revision of the resource of that name; one that changes nothing makes none. If
  /// `resource` has an etag that is no longer the present one, the update is refused (ABORTED).
  template <class Resource>
  Resource update(const Resource& resource, const UpdateOptions& options = {});
  // Batches: all of them or none. One may be derived from another one, in any order.
  /// Adds resources under the ids in their names.
  template <class Resource>
  BatchResult<Resource> create_all(const std::vector<Resource>& resources,
                                   bool validate_only = false);
  /// Updates each as update() does; with `allow_missing` creates those that are not there.
  template <class Resource>
  BatchResult<Resource> update_all(const std::vector<ResourceUpdate<Resource>>& updates,
                                   bool allow_missing = false, bool validate_only = false);
  /// Newest first; limit 0: all.
  template <class Resource>
  Listing<Resource> revisions(const std::string& name, int limit = 0);
  /// Hides it from lists and from new simulations; nothing is lost.
  template <class Resource>
  Resource remove(const std::string& name, const std::string& etag = "");
  template <class Resource>
  Resource undelete(const std::string& name, const std::string& etag = "");

  // From tables of numbers, given as CSV texts; see the requests for their columns.
  v1::Lubricant import_lubricant(const v1::ImportLubricantRequest& request);
  v1::GearSet import_gear_set(const v1::ImportGearSetRequest& request);
  v1::Surface import_surface_profiles(const v1::ImportSurfaceProfilesRequest& request);

  /// What the server accepts: the constraints of one message, e.g. "Lubricant", or everything.
  v1::Schema schema(const std::string& message = "");

  /// Returns at once. A server that is lost meanwhile is asked again under the same request_id.
  v1::Simulation create_simulation(const v1::Simulation& simulation,
                                   const CreateOptions& options = {});
  v1::Simulation get_simulation(const std::string& name);
  v1::Simulation cancel_simulation(const std::string& name);
  /// Without results; newest first unless ordered otherwise. Filters by state, lubricant,
  /// create_time and labels.
  Listing<v1::Simulation> list_simulations(const ListOptions& options = {});
  /// Keeps it from expiring and from being evicted, or gives it up again.
  v1::Simulation pin_simulation(const std::string& name);
  v1::Simulation unpin_simulation(const std::string& name);
  /// Blocks until the simulation has ended and returns it with its result. `on_event` hears of each
  /// change of state, once and in order, and of progress, in the calling thread. A stream that
  /// breaks is taken up again behind what was heard, for a while. When `stop` is requested, the
  /// simulation is returned as it stands.
  v1::Simulation wait_for_end(const std::string& name,
                              const std::function<void(const v1::SimulationEvent&)>& on_event = {},
                              const std::stop_token& stop = {});
  /// A history, or an overview of it, put together.
  v1::History read_history(const std::string& name, const HistoryOptions& options = {});
  /// Hands over rows as they come, each once and in order, in the calling thread. A stream that
  /// breaks is taken up again at the first row that is missing, for a while.
  void stream_history(const std::string& name, const HistoryOptions& options,
                      const std::function<void(const v1::HistorySchema&)>& on_schema,
                      const std::function<void(const HistoryRows&)>& on_rows);

  v1::EvaluateContactResponse evaluate_contact(const v1::EvaluateContactRequest& request);

 private:
  struct Services;
  std::unique_ptr<Services> services_;
};

/// Whether nothing will change any more: succeeded, failed or cancelled.
bool has_ended(v1::Simulation::State state);

}  // namespace tribodyn::client
