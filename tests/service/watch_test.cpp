// Tests of WatchSimulations.
#include <SQLiteCpp/Database.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <memory_resource>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "google/rpc/code.pb.h"
#include "google/rpc/error_details.pb.h"
#include "server/application/request_project.h"
#include "server/application/simulations.h"
#include "server/application/streams.h"
#include "server/storage/event_rows.h"
#include "server/storage/maintenance.h"
#include "server/storage/recent_events.h"
#include "server/storage/seeds.h"
#include "server/support/observers.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using Step = AnyMessageSource::Step;
using State = v1::Simulation;
using Events = std::vector<v1::SimulationEvent>;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class CountingObserver : public Observer {
 public:
  void changed() override { ++count; }
  std::atomic<int> count = 0;
};

class WatchTest : public testing::Test {
 protected:
  /// Opens a watch as the dispatcher does.
  StreamOutcome<v1::SimulationEvent> open(v1::WatchSimulationsRequest request) {
    Application app = bench_.application();
    CallContext context;
    if (auto refused = enter_project(app, request, context)) return *refused;
    return watch_simulations(app, request, context);
  }
  static v1::WatchSimulationsRequest of(const std::vector<std::string>& names,
                                        std::int64_t after = 0) {
    v1::WatchSimulationsRequest out;
    for (const std::string& name : names) out.add_names(name);
    out.set_after_event_number(after);
    return out;
  }
  static v1::WatchSimulationsRequest that_satisfy(const std::string& filter,
                                                  std::int64_t after = 0) {
    v1::WatchSimulationsRequest out;
    out.set_filter(filter);
    out.set_after_event_number(after);
    return out;
  }
  /// Reads until the stream ends or has nothing more; without progress and heartbeats.
  static Events read(MessageSource<v1::SimulationEvent>& source, Step* last = nullptr) {
    Events out;
    v1::SimulationEvent event;
    Step step = source.next(event);
    for (; step == Step::kMessage; step = source.next(event)) {
      if (event.kind() == v1::SimulationEvent::STATE_CHANGE ||
          event.kind() == v1::SimulationEvent::DELETED) {
        out.push_back(event);
      }
    }
    if (last != nullptr) *last = step;
    return out;
  }
  Events read(const v1::WatchSimulationsRequest& request) {
    const auto outcome = open(request);
    EXPECT_TRUE(outcome.ok()) << outcome.error().message();
    return outcome.ok() ? read(*outcome.message()) : Events();
  }
  static std::string reason(const google::rpc::Status& status) {
    google::rpc::ErrorInfo info;
    for (const auto& each : status.details()) {
      if (each.UnpackTo(&info)) return info.reason();
    }
    return {};
  }
  static std::vector<std::string> names_of(const Events& events) {
    std::vector<std::string> out;
    for (const auto& each : events) out.push_back(each.name());
    return out;
  }
  std::string finished(const std::string& part = "none") {
    v1::Simulation simulation = point_simulation();
    v1::Label& label = *simulation.add_labels();
    label.set_key("part");
    label.set_value(part);
    std::string name = bench_.create(simulation);
    EXPECT_TRUE(bench_.reaches(name, State::SUCCEEDED));
    return name;
  }
  std::string finished_in(const std::string& project) {
    Application app = bench_.application();
    v1::CreateSimulationRequest request;
    *request.mutable_simulation() = point_simulation();
    CallContext context;
    context.project = project;
    std::string name = create_simulation(app, request, context).message().name();
    EXPECT_TRUE(eventually([&] { return stored(name)->state == StoredState::kSucceeded; }));
    return name;
  }
  std::optional<StoredSimulation> stored(const std::string& name) {
    const auto parts = split_name(name);
    return bench_.store().numbered_simulation(std::string(parts->project),
                                              *simulation_id(parts->relative));
  }
  void remove(const std::string& name) {
    EXPECT_EQ(bench_.store().remove_simulation(stored(name)->id), Store::Removal::kDone);
  }
  std::int64_t latest() { return bench_.store().event_range("default").latest; }
  /// Changes the database past the trigger that an event belongs to a simulation.
  void add_events(const std::string& sql) {
    SQLite::Database db = bench_.open_database();
    const std::string trigger =
        db.execAndGet("SELECT sql FROM sqlite_master WHERE name = 'events_have_a_simulation'")
            .getString();
    db.exec("DROP TRIGGER events_have_a_simulation");
    db.exec(sql);
    db.exec(trigger);
  }

  Bench bench_;
};

TEST_F(WatchTest, OneStreamTellsTheEventsOfAllNamedSimulationsInOrder) {
  const std::string first = finished(), other = finished(), second = finished();
  Step last = Step::kWait;
  const auto source = open(of({second, first, second})).message();
  const Events events = read(*source, &last);
  EXPECT_EQ(last, Step::kEnd) << "all have ended";
  EXPECT_THAT(names_of(events), ElementsAre(first, first, first, second, second));
  std::int64_t number = 0;
  for (const auto& each : events) {
    EXPECT_GT(each.event_number(), number);
    number = each.event_number();
  }
  EXPECT_EQ(events.back().state(), State::SUCCEEDED);
  EXPECT_EQ(events.back().progress_fraction(), 1);
}

TEST_F(WatchTest, AResumedStreamTellsExactlyTheRest) {
  const std::vector<std::string> names = {finished(), finished()};
  const Events all = read(of(names));
  for (std::size_t known = 1; known <= all.size(); ++known) {
    const Events rest = read(of(names, all[known - 1].event_number()));
    ASSERT_THAT(rest, SizeIs(all.size() - known));
    for (std::size_t i = 0; i < rest.size(); ++i) {
      EXPECT_EQ(rest[i].SerializeAsString(), all[known + i].SerializeAsString());
    }
  }
}

TEST_F(WatchTest, AFilterTellsOfLaterSimulationsToo) {
  const std::string before = finished("axle");
  const auto source = open(that_satisfy("labels.part = axle", latest())).message();
  const auto observer = std::make_shared<CountingObserver>();
  source->observe(observer);
  EXPECT_THAT(read(*source), IsEmpty());
  const int told = observer->count;
  finished("gearbox");
  const std::string later = finished("axle");
  EXPECT_GT(observer->count, told) << "commits wake it";
  Step last = Step::kEnd;
  EXPECT_THAT(names_of(read(*source, &last)), ElementsAre(later, later)) << "QUEUED, SUCCEEDED";
  EXPECT_EQ(last, Step::kWait) << "it does not end";
  EXPECT_THAT(names_of(read(that_satisfy("labels.part = axle"))),
              ElementsAre(before, before, before, later, later));
}

TEST_F(WatchTest, WithoutNamesAndFilterItTellsOfAllSimulationsOfTheProjectAlsoLaterOnes) {
  bench_.store().add_project("acme", seed_resources(), 1);
  const std::string before = finished("axle");
  finished_in("acme");
  const auto source = open({}).message();
  const auto observer = std::make_shared<CountingObserver>();
  source->observe(observer);
  EXPECT_THAT(names_of(read(*source)), ElementsAre(before, before, before));
  const std::string later = finished("gearbox");
  remove(before);
  Step last = Step::kEnd;
  EXPECT_THAT(names_of(read(*source, &last)), ElementsAre(later, later, before));
  EXPECT_EQ(last, Step::kWait) << "it does not end";
  v1::WatchSimulationsRequest of_acme;
  of_acme.set_parent("projects/acme");
  EXPECT_THAT(read(of_acme), SizeIs(3));
}

TEST_F(WatchTest, AClientThatResumesLearnsOfEverythingThatWasDeleted) {
  const std::string seen = finished(), unseen = finished();
  const std::int64_t known = read(of({seen})).back().event_number();
  remove(unseen);
  const Events events = read(that_satisfy("lubricant = paper-fluid-1", known));
  ASSERT_THAT(events, SizeIs(1));
  EXPECT_EQ(events[0].kind(), v1::SimulationEvent::DELETED);
  EXPECT_EQ(events[0].name(), unseen);
  EXPECT_EQ(events[0].state(), State::STATE_UNSPECIFIED);
  EXPECT_THAT(names_of(read(of({unseen}, known))), ElementsAre(unseen)) << "named too";
  EXPECT_EQ(open(of({unseen})).error().code(), google::rpc::NOT_FOUND);
  EXPECT_THAT(check_database(bench_.database()), IsEmpty());
}

TEST_F(WatchTest, AStreamIsOfOneProject) {
  bench_.store().add_project("acme", seed_resources(), 1);
  const std::string mine = finished(), other = finished_in("acme");
  ASSERT_EQ(mine, "simulations/1");
  ASSERT_EQ(other, "projects/acme/simulations/1");
  const auto thrice = [](const std::string& name) { return ElementsAre(name, name, name); };
  auto filtered = that_satisfy("lubricant = paper-fluid-1");
  EXPECT_THAT(names_of(read(filtered)), thrice(mine));
  filtered.set_parent("projects/acme");
  EXPECT_THAT(names_of(read(filtered)), thrice(other));
  EXPECT_THAT(names_of(read(of({other}))), thrice(other));
  EXPECT_THAT(names_of(read(of({mine}))), thrice(mine));
  auto relative = of({mine});
  relative.set_parent("projects/acme");
  EXPECT_THAT(names_of(read(relative)), thrice(other));
  EXPECT_THAT(complaints(open(of({other, "projects/default/simulations/1"})).error()),
              HasSubstr("names[1]: \"projects/default/simulations/1\" belongs to another project"));
  EXPECT_EQ(open(of({"projects/acme/simulations/2"})).error().code(), google::rpc::NOT_FOUND);
}

TEST_F(WatchTest, ADeletionIsToldInItsProject) {
  bench_.store().add_project("acme", seed_resources(), 1);
  const std::string mine = finished(), other = finished_in("acme");
  const std::int64_t known = latest();
  remove(mine);
  remove(other);
  auto filtered = that_satisfy("lubricant = paper-fluid-1", known);
  EXPECT_THAT(names_of(read(filtered)), ElementsAre(mine));
  filtered.set_parent("projects/acme");
  EXPECT_THAT(names_of(read(filtered)), ElementsAre(other));
  EXPECT_THAT(names_of(read(of({other}, known))), ElementsAre(other));
  EXPECT_THAT(names_of(read(of({mine}, known))), ElementsAre(mine));
  EXPECT_THAT(check_database(bench_.database()), IsEmpty());
}

TEST_F(WatchTest, AStreamEndsAfterADeletionThatTheClientHas) {
  const std::string name = finished();
  const std::int64_t known = latest();
  remove(name);
  Step last = Step::kWait;
  EXPECT_THAT(read(*open(of({name}, known)).message(), &last), SizeIs(1));
  EXPECT_EQ(last, Step::kEnd);
  EXPECT_THAT(read(*open(of({name}, latest())).message(), &last), IsEmpty());
  EXPECT_EQ(last, Step::kEnd);
}

TEST_F(WatchTest, NumbersAreNeverGivenTwice) {
  const std::string name = finished();
  const std::int64_t before = latest();
  remove(name);
  EXPECT_GT(latest(), before);
  const std::string next = finished();
  EXPECT_GT(read(of({next})).front().event_number(), before + 1);
}

TEST_F(WatchTest, NumbersSayNothingOfOtherProjects) {
  bench_.store().add_project("acme", seed_resources(), 1);
  const auto latest_in = [&](const std::string& project) {
    return bench_.store().event_range(project).latest;
  };
  const std::string first = finished();
  EXPECT_EQ(latest(), 3);
  EXPECT_EQ(latest_in("acme"), 0);
  for (int i = 0; i < 3; ++i) remove(finished_in("acme"));
  EXPECT_EQ(latest(), 3) << "neither simulations nor deletions of acme count";
  EXPECT_EQ(latest_in("acme"), 12);
  const auto resumed = open(that_satisfy("lubricant = paper-fluid-1", latest())).message();
  const std::string second = finished();
  const Events events = read(*resumed);
  EXPECT_THAT(names_of(events), ElementsAre(second, second)) << "resumed without a gap";
  EXPECT_EQ(events.front().event_number(), 4);
  EXPECT_EQ(events.back().event_number(), 5);
  Application app = bench_.application();
  EXPECT_EQ(list_simulations(app, {}, {}).message().event_number(), 5);
  EXPECT_THAT(check_database(bench_.database()), IsEmpty());
}

TEST_F(WatchTest, AProjectForgetsOnlyItsOwnDeletions) {
  bench_.store().add_project("acme", seed_resources(), 1);
  const std::string name = finished();
  SQLite::Database(bench_.database(), SQLite::OPEN_READWRITE)
      .exec("UPDATE projects SET last_event = 9, forgotten_event = 9 WHERE name = 'acme'");
  EXPECT_THAT(read(of({name}, 1)), SizeIs(2)) << "nothing of this project is missing";
}

TEST_F(WatchTest, AClientThatResumesBeforeForgottenDeletionsIsRefused) {
  const std::string name = finished();
  SQLite::Database(bench_.database(), SQLite::OPEN_READWRITE)
      .exec("UPDATE projects SET forgotten_event = 2");
  const auto refused = open(of({name}, 1)).error();
  EXPECT_EQ(refused.code(), google::rpc::OUT_OF_RANGE);
  EXPECT_EQ(reason(refused), "EVENTS_FORGOTTEN");
  EXPECT_THAT(read(of({name}, 2)), SizeIs(1));
  EXPECT_THAT(read(of({name})), SizeIs(3)) << "without a number nothing can be missing";
}

TEST_F(WatchTest, TheOldestDeletionsAreForgotten) {
  const std::string kept = finished(), removed = finished();
  add_events(
      "INSERT INTO events (simulation, sequence, time, state, attempt, reason, project, number, "
      "simulation_number) "
      "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < " +
      std::to_string(kKeptDeletions + 999) +
      ") SELECT 1000000 + i, 1, 0, 0, 1, '', 'default', 1000 + i, 1000000 + i FROM n");
  SQLite::Database db = bench_.open_database();
  db.exec("UPDATE projects SET last_number = 2000000, last_event = 1000 + " +
          std::to_string(kKeptDeletions + 999) +
          ", deletions = " + std::to_string(kKeptDeletions + 999));
  const std::int64_t first = latest() - (kKeptDeletions + 999) + 1;
  remove(removed);
  EXPECT_EQ(bench_.store().event_range("default").forgotten, first + 999);
  EXPECT_THAT(check_database(bench_.database()), IsEmpty());
  EXPECT_THAT(read(of({kept})), SizeIs(3)) << "events of what is there stay";
}

TEST_F(WatchTest, AStreamComesForwardWhereNothingMatches) {
  const std::string name = finished("axle");
  add_events(
      "INSERT INTO events (simulation, sequence, time, state, attempt, reason, project, number) "
      "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < " +
      std::to_string(2 * kEventWindow) +
      ") SELECT 1000000 + i, 1, 0, 1, 1, '', 'default', 3 + i FROM n");
  SQLite::Database(bench_.database(), SQLite::OPEN_READWRITE)
      .exec("UPDATE projects SET last_event = 3 + " + std::to_string(2 * kEventWindow));
  const std::string later = finished("axle");
  const auto source = open(that_satisfy("labels.part = axle", 3)).message();
  v1::SimulationEvent event;
  ASSERT_EQ(source->next(event), Step::kMessage);
  EXPECT_EQ(event.kind(), v1::SimulationEvent::HEARTBEAT);
  EXPECT_EQ(event.event_number(), 3 + kEventWindow) << "says how far it has come";
  EXPECT_THAT(names_of(read(*source)), ElementsAre(later, later));
}

TEST_F(WatchTest, RefusesWhatItCannotFollow) {
  const std::string name = finished();
  auto both = of({name});
  both.set_filter("lubricant = paper-fluid-1");
  EXPECT_THAT(complaints(open(both).error()), HasSubstr("filter"));
  EXPECT_THAT(complaints(open(that_satisfy("state = RUNNING")).error()),
              HasSubstr("state changes with events"));
  EXPECT_THAT(complaints(open(of({name, "lubricants/paper-fluid-1"})).error()),
              HasSubstr("names[1]"));
  EXPECT_THAT(complaints(open(of({name}, latest() + 1)).error()), HasSubstr("allowed: 0 to 3"));
  EXPECT_EQ(open(of({name}, -1)).error().code(), google::rpc::INVALID_ARGUMENT);
  EXPECT_EQ(open(of({name, "simulations/99"})).error().code(), google::rpc::NOT_FOUND);
}

TEST_F(WatchTest, ManyWatchesWithoutNamesAreRefusedUntilOneIsClosed) {
  Application app = bench_.application();
  auto request = that_satisfy("lubricant = paper-fluid-1");
  std::vector<std::shared_ptr<MessageSource<v1::SimulationEvent>>> sources;
  for (std::size_t i = 0; i < kMostProjectWatches * 3 / 4; ++i) {
    sources.push_back(watch_simulations(app, request).message());
    request.clear_filter();  // with and without a filter they count together
  }
  const auto refused = watch_simulations(app, request).error();
  EXPECT_EQ(refused.code(), google::rpc::RESOURCE_EXHAUSTED);
  EXPECT_EQ(reason(refused), "TOO_MANY_STREAMS");
  EXPECT_TRUE(watch_simulations(app, of({finished()})).ok()) << "names are not limited";
  sources.pop_back();
  EXPECT_TRUE(watch_simulations(app, request).ok());
}

TEST(SharedPlaces, NeitherAPrincipalNorAProjectTakesThePlacesOfOthers) {
  const SharedPlaces places(8);
  std::vector<std::shared_ptr<void>> held;
  const auto take = [&](const std::string& principal, const std::string& project) {
    held.push_back(places.take(principal, project));
    return held.back() != nullptr;
  };
  for (int i = 0; i < 6; ++i) EXPECT_TRUE(take("hog", "alpha"));
  EXPECT_FALSE(take("hog", "alpha"));
  EXPECT_FALSE(take("hog", "beta")) << "the principal has its share";
  EXPECT_FALSE(take("other", "alpha")) << "the project has its share";
  EXPECT_TRUE(take("other", "beta"));
  EXPECT_TRUE(take("other", "beta"));
  EXPECT_FALSE(take("third", "gamma")) << "all are taken";
  EXPECT_EQ(places.taken(), 8U);
  held.clear();
  EXPECT_EQ(places.taken(), 0U);
}

TEST_F(WatchTest, AListSaysAfterWhichEventToWatch) {
  finished();
  Application app = bench_.application();
  EXPECT_EQ(list_simulations(app, {}).message().event_number(), latest());
}

TEST_F(WatchTest, ARunningSimulationTellsItsProgress) {
  const auto release = std::make_shared<std::atomic<bool>>(false);
  bench_.restart(patient_studies(release));
  const std::string name = bench_.create(point_simulation());
  ASSERT_TRUE(bench_.reaches(name, State::RUNNING));
  const std::vector<v1::WatchSimulationsRequest> requests = {
      of({name}),
      of({name}, latest()),
      that_satisfy("lubricant = paper-fluid-1"),
      that_satisfy("lubricant = paper-fluid-1", latest()),
      {}};
  for (const auto& request : requests) {
    const auto source = open(request).message();
    source->observe(std::make_shared<CountingObserver>());
    v1::SimulationEvent event;
    EXPECT_TRUE(eventually([&] {
      return source->next(event) == Step::kMessage && event.kind() == v1::SimulationEvent::PROGRESS;
    })) << request.DebugString();
    EXPECT_EQ(event.name(), name);
    EXPECT_EQ(event.state(), State::RUNNING);
    EXPECT_EQ(event.sequence(), 2);
    EXPECT_EQ(event.event_number(), latest());
  }
  *release = true;
}

TEST_F(WatchTest, EveryWatchHasEachEventOnceWhereverItBeginsAndWheneverItReads) {
  // More events than are kept in memory, among simulations of which a watch names every other one.
  constexpr int kSimulations = 40, kRounds = 25;
  std::vector<std::string> names, even;
  const ResultKey key{std::string(64, 'a'), "model", "platform"};
  for (int i = 0; i < kSimulations; ++i) {
    const bool is_even = i % 2 == 0;
    bench_.store().add_simulation({.request = "r",
                                   .key = key,
                                   .labels = {{"part", is_even ? "even" : "odd"}},
                                   .revisions = {.lubricant = "lubricants/paper-fluid-1@1"}},
                                  1);
    names.push_back("simulations/" + std::to_string(i + 1));
    if (is_even) even.push_back(names.back());
  }
  const std::int64_t begin = latest();
  struct Reader {
    std::shared_ptr<MessageSource<v1::SimulationEvent>> source;
    std::int64_t after = 0;
    bool is_of_even = false;
    std::vector<std::int64_t> numbers = {};
  };
  std::mt19937 random(7);
  std::vector<Reader> readers;
  std::vector<std::int64_t> all, of_even;
  for (int round = 0; round < kRounds; ++round) {
    const std::int64_t after = begin + static_cast<int>(random() % (latest() - begin + 1));
    const bool is_of_even = round % 2 == 0;
    const auto source =
        round % 4 < 2
            ? open(of(is_of_even ? even : names, after))
            : open(that_satisfy(is_of_even ? "labels.part = even" : "lubricant = paper-fluid-1",
                                after));
    ASSERT_TRUE(source.ok()) << source.error().message();
    readers.push_back({source.message(), after, is_of_even});
    for (int i = 0; i < kSimulations; ++i) {
      const auto simulation = *stored(names[i]);
      const auto event = round % 2 == 0
                             ? bench_.store().mark_running(simulation.id, 1, key)
                             : bench_.store().mark_queued(simulation.id, 1, "SERVER_LOST");
      ASSERT_TRUE(event);
      all.push_back(event->number);
      if (i % 2 == 0) of_even.push_back(event->number);
      for (Reader& each : readers) {
        if (random() % 40 != 0) continue;
        for (const auto& told : read(*each.source)) each.numbers.push_back(told.event_number());
      }
    }
  }
  for (Reader& each : readers) {
    for (const auto& told : read(*each.source)) each.numbers.push_back(told.event_number());
    std::vector<std::int64_t> expected = each.is_of_even ? of_even : all;
    std::erase_if(expected, [&](std::int64_t number) { return number <= each.after; });
    EXPECT_EQ(each.numbers, expected) << "after " << each.after;
  }
}

TEST_F(WatchTest, NothingIsMissedWhileManySimulationsRun) {
  constexpr int kThreads = 3, kEach = 30;
  const auto source = open(that_satisfy("lubricant = paper-fluid-1")).message();
  source->observe(std::make_shared<CountingObserver>());
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([this, i] {
      for (int k = 0; k < kEach; ++k) {
        v1::Simulation simulation = point_simulation();
        simulation.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(
            40 + i + 0.1 * k);
        bench_.create(simulation);
      }
    });
  }
  std::map<std::string, std::int64_t> told;  // sequence by name
  int ended = 0;
  std::int64_t number = 0;
  EXPECT_TRUE(eventually([&] {
    for (const auto& each : read(*source)) {
      EXPECT_EQ(each.sequence(), ++told[each.name()]) << "every event once and in order";
      EXPECT_GT(each.event_number(), number);
      number = each.event_number();
      ended += each.state() == State::SUCCEEDED ? 1 : 0;
    }
    return ended == kThreads * kEach;
  }));
  for (std::thread& thread : threads) thread.join();
}

/// A database of events that counts how often it is read.
struct CountedEvents {
  void add(std::int64_t simulation, std::int64_t sequence, StoredState state) {
    StoredEvent event;
    event.number = ++latest;
    event.simulation = 100 + simulation;
    event.simulation_number = simulation;
    event.sequence = sequence;
    event.state = state;
    events.push_back(event);
    recent.note_change();
  }
  std::vector<std::int64_t> after(std::int64_t number) {
    const auto page = recent.after("default", number, source);
    if (!page) return {-1};
    EXPECT_EQ(page->through, std::max(number, latest));
    std::vector<std::int64_t> out;
    for (const StoredEvent& each : page->events) out.push_back(each.number);
    return out;
  }
  RecentEvents::States states(const std::vector<std::int64_t>& numbers) {
    return recent.states("default", numbers, source);
  }

  RecentEvents recent;
  std::vector<StoredEvent> events;
  std::int64_t latest = 0;
  int reads = 0, state_reads = 0;
  RecentEvents::Source source = {
      [this](std::int64_t after) {
        ++reads;
        EventPage out;
        for (const StoredEvent& each : events) {
          if (each.number > after && out.events.size() < kEventPage) out.events.push_back(each);
        }
        out.more = out.events.size() == kEventPage;
        out.through = out.more ? out.events.back().number : std::max(after, latest);
        return out;
      },
      [this] { return latest; },
      [this](const std::vector<std::int64_t>& numbers) {
        ++state_reads;
        RecentEvents::States out;
        for (const std::int64_t each : numbers) {
          out.emplace_back(std::nullopt);
          for (const StoredEvent& event : events) {
            if (event.simulation_number != each) continue;
            out.back() = SimulationState{event.simulation, event.state, event.attempt,
                                         event.sequence, event.number};
            if (event.state == StoredState::kDeleted) out.back().reset();
          }
        }
        return out;
      }};
};

TEST(RecentEvents, AreReadOnceForAllWatches) {
  CountedEvents base;
  base.add(1, 1, StoredState::kQueued);
  EXPECT_THAT(base.after(1), IsEmpty());
  for (int i = 0; i < 3; ++i) {
    base.add(1, 2 + i, StoredState::kRunning);
    for (int k = 0; k < 5; ++k) EXPECT_THAT(base.after(1 + i), ElementsAre(2 + i));
  }
  EXPECT_EQ(base.reads, 3);
  EXPECT_THAT(base.after(1), ElementsAre(2, 3, 4));
  EXPECT_THAT(base.after(0), ElementsAre(-1)) << "what was there before the first watch";
}

TEST(RecentEvents, ReachBackSoManyEventsAndBeginAnewAfterAGap) {
  CountedEvents base;
  EXPECT_THAT(base.after(0), IsEmpty());
  const auto most = static_cast<std::int64_t>(RecentEvents::kKept);
  for (std::int64_t i = 1; i <= most + 10; ++i) {
    base.add(1, i, StoredState::kQueued);
    base.after(base.latest);
  }
  EXPECT_THAT(base.after(9), ElementsAre(-1));
  EXPECT_THAT(base.after(10), SizeIs(RecentEvents::kKept));
  for (int i = 0; i < kEventPage; ++i) base.add(2, 1 + i, StoredState::kQueued);
  EXPECT_THAT(base.after(base.latest - 1), ElementsAre(-1));
  base.add(3, 1, StoredState::kQueued);
  EXPECT_THAT(base.after(base.latest - 1), ElementsAre(base.latest));
}

TEST(RecentEvents, ADeletionTakesThePlaceOfTheOtherEventsOfItsSimulation) {
  CountedEvents base;
  EXPECT_THAT(base.after(0), IsEmpty());
  base.add(1, 1, StoredState::kQueued);
  base.add(2, 1, StoredState::kQueued);
  EXPECT_THAT(base.after(0), ElementsAre(1, 2));
  base.add(1, 2, StoredState::kDeleted);
  EXPECT_THAT(base.after(0), ElementsAre(2, 3));
}

TEST(RecentEvents, StatesFollowTheEventsWithoutAFurtherRead) {
  CountedEvents base;
  base.add(1, 1, StoredState::kQueued);
  base.add(2, 1, StoredState::kQueued);
  for (int i = 0; i < 3; ++i) {
    const auto states = base.states({2, 1, 2});
    EXPECT_EQ(states[1]->id, 101);
    EXPECT_EQ(states[2]->sequence, 1);
  }
  EXPECT_EQ(base.state_reads, 1);
  base.add(1, 2, StoredState::kRunning);
  const auto states = base.states({1});
  EXPECT_EQ(states[0]->state, StoredState::kRunning);
  EXPECT_EQ(states[0]->event_number, 3);
  EXPECT_EQ(base.state_reads, 1);
  base.add(1, 3, StoredState::kDeleted);
  EXPECT_FALSE(base.states({1})[0]);
  EXPECT_FALSE(base.states({7})[0]);
}

TEST(Observers, ThoseThatAreGoneTakeNoMemoryForLong) {
  /// Counts the blocks of memory of observers, which a weak pointer keeps alive.
  struct Resource : std::pmr::memory_resource {
    void* do_allocate(std::size_t bytes, std::size_t alignment) override {
      ++blocks;
      return std::pmr::new_delete_resource()->allocate(bytes, alignment);
    }
    void do_deallocate(void* at, std::size_t bytes, std::size_t alignment) override {
      --blocks;
      std::pmr::new_delete_resource()->deallocate(at, bytes, alignment);
    }
    bool do_is_equal(const memory_resource& other) const noexcept override {
      return this == &other;
    }
    int blocks = 0;
  };
  Resource memory;
  const std::pmr::polymorphic_allocator<CountingObserver> allocator(&memory);
  Observers observers;
  const auto kept = std::allocate_shared<CountingObserver>(allocator);
  observers.add(kept);
  for (int i = 0; i < 1000; ++i) observers.add(std::allocate_shared<CountingObserver>(allocator));
  EXPECT_LE(memory.blocks, 10);
  observers.tell();
  EXPECT_EQ(kept->count, 1);
}

}  // namespace
}  // namespace tribodyn::server
