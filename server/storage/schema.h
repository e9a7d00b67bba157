#pragma once

#include <string>
#include <vector>

#include "server/storage/connection.h"

namespace tribodyn::server {

/// The tables of a database, schema 1. Times are microseconds since 1970 (UTC). Messages are the
/// protos of tribodyn.v1 in binary form.
///
///   format       one row: the fingerprint of the program that wrote the database (SchemaStep)
///   projects     one row per project; last_number is that of its latest simulation, removed or
///                not, and last_event that of its latest event. deletions: how many events of state
///                0 it has; forgotten_event: the largest number of those that were forgotten since
///                (kKeptDeletions); last_campaign: number of its latest campaign, removed or not;
///                simulations: how many it has, kept by triggers
///   resources    lubricants, gear sets, surfaces, vehicles: one row a name, with the revision that
///                is the present one; delete_time is set while it is deleted (nothing is lost).
///                name and collection are full ones, "projects/acme/lubricants/my-oil": the project
///                is a part of both keys, here and in properties, and no query can leave it out
///   revisions    what a resource was: never changed and never removed, numbered 1, 2, ... without
///                gaps. content_hash: SHA-256 of body, 64 hex digits
///   properties   what lists are filtered and ordered by: the values of the present revision
///                (properties.h); derived from it, kept in step with it
///   simulations  one row per job; id is the order of creation over all projects, number the one in
///                its name, counted within its project. state as in Simulation.State; its changes
///                are those of life_cycle.h. attempt counts from 1, lost_attempts those that ended
///                with the server's process; sequence is that of the latest event. request: the
///                Simulation as the client stated it; request_hash: of all that it stated
///                (request_text.h), to tell a repeated request_id, unique in its project, from a
///                misused one; lubricant, gear_set, surface, vehicle: the revisions it rests on.
///                is_forced: no result that was there before is taken. Progress is not kept: a job
///                that a crash interrupts starts again. client: what the client calls itself;
///                principal: whose share of the processors pays for it; scheduling_class:
///                SchedulingClass; cost_seconds: estimated, of one processor. lease_worker,
///                lease_expire_time: who computes it, set while it is RUNNING; after that time the
///                attempt counts as lost. The worker "local" is the server's own process, whose
///                leases end with it. pinned: neither expires nor is evicted; others may go, with
///                their events and with a result and a ledger that no other one has
///   simulation_labels  what lists are filtered by beside columns of simulations, of its request
///   events       every change of state of a job, written with it. number: among those of all jobs
///                of the project, in the order of their commits, never given twice: it says nothing
///                of other projects; sequence: among those of the job, 1, 2, ... without gaps. When
///                a job is removed one event of state 0 takes the place of its events, and tells
///                watchers: it has the number of the job, whose row is gone
///   ledgers      assumptions of results, each distinct list once: a SimulationResult with nothing
///                else. They belong to the job, as they name its resources
///   results      one SimulationResult without assumptions for equal inputs (input_hash), model
///                version and platform in one project, written with the change of state of the
///                first job that has it. checksum: of body (checksum.h); stored_bytes: of body and
///                of the blocks of its history, which go together
///   campaigns    one row per campaign; number counts within its project. state as in
///                Campaign.State, stop_reason and stop_message why it is paused or failed.
///                request: the Campaign as the client stated it, without its candidates, which are
///                the Campaign candidate_table; the name, labels, weights and attributes may
///                change, candidates may be added. points_done and the like change with each tile.
///                lost_attempts: processes that began to compute it and neither ended in good order
///                nor wrote tiles for long, where no suspect explains the loss. lost_candidates:
///                those that are refused because processes were lost while they computed them,
///                since the campaign was resumed. stored_bytes: of both messages and of all blobs.
///                When a campaign is removed, all below goes with it
///   campaign_labels  what lists are filtered by beside columns of campaigns, of its request
///   campaign_lubricants  the lubricants that are candidates, in their revisions
///   campaign_appends  one row for each request that added candidates: the first of them;
///                request_id, unique in its campaign; request_hash, which differs if the id was
///                used for another request
///   campaign_tiles  runs of rows that are computed; whole candidates each, in no row two
///   campaign_blobs  columns of tiles, compressed (column_codec.h). number: that of the column
///                (campaign_columns.h). checksum: of data
///   campaign_refusals  the sentences that column 0 numbers
///   campaign_suspects  runs of rows without a tile that are computed one at a time, because an
///                earlier process was lost; whole candidates each. is_begun: a process computes
///                them; if it is lost, they are halved. lost_attempts: processes that were lost
///                while they computed this one candidate
///   history_columns  of time histories, in the order of position; ids are never used again
///   history_blocks   a column cut into runs of kHistoryBlock doubles, numbered 0, 1, ..., and each
///                compressed (column_codec.h): level 0 as it is, levels above it the least and
///                largest values of runs of its rows (pyramid.h), written once with it. checksum:
///                of data
///   tokens       one row for each bearer token: SHA-256 of its secret, the name of its principal,
///                Scope, projects joined by commas (empty: all), until when it is accepted, and its
///                quotas where they are not the server's. A token is never removed, and a revoked
///                one never changes
///   token_log    one row: the number of changes of tokens, the number of those that the server has
///                applied, and the key of page tokens
inline constexpr int kApplicationId = 0x54524244;  // "TRBD"

/// What makes a schema of the one before: SQL, then an action for what SQL cannot do.
struct SchemaStep {
  const char* text;
  void (*convert)(Connection&);  ///< null: none
  /// Of the databases of the schema, 64 hex digits. A database with another one is not opened.
  std::string fingerprint;
};

/// The step at index n makes schema n + 1 of schema n; schema 0 is an empty database. The last one
/// makes the present schema.
using SchemaSteps = std::vector<SchemaStep>;

/// The steps of this program. Until the release of 0.1.0 there is one, whose text and messages may
/// change in every commit; its fingerprint is the SHA-256 of both (wire_layout.h). From then on
/// whoever changes a table or a message that is stored adds a step, and writes the fingerprint of
/// the released one down as a constant: what a release has written never changes.
const SchemaSteps& schema_steps();

/// Brings a database of schema `from`, 0 for an empty one, to the present schema in one
/// transaction.
void migrate(Connection& database, int from, const SchemaSteps& steps);

/// How the tables, indexes, triggers and views of a database differ from those that this program
/// makes for its schema, a sentence each. Whoever adds a trigger changes what every write does.
/// Requires check_identity() (database_check.h). Throws SQLite::Exception.
std::vector<std::string> schema_differences(Connection& database, const SchemaSteps& steps);

}  // namespace tribodyn::server
