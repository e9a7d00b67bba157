// Curves and histories over REST as columns: CSV, JSON, NumPy and binary. Their numbers are those
// of the messages, bit for bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "server/application/campaigns.h"
#include "server/application/streams.h"
#include "server/transport/http/column_text.h"
#include "server/transport/http/http_server.h"
#include "tests/service/http_client.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class ColumnsTest : public testing::Test {
 protected:
  ColumnsTest() { accept_owner(app_); }

  /// Head and body of the answer; HTTP/1.0 has no chunks.
  std::pair<std::string, std::string> answer(const std::string& target,
                                             const std::string& headers = {}) {
    HttpConnection client(server_.address().port);
    client.send("GET " + target + " HTTP/1.0\r\n" + kHost + headers + "\r\n");
    const std::string all = client.read_all();
    const std::size_t end = all.find("\r\n\r\n");
    return {all.substr(0, end), end == std::string::npos ? "" : all.substr(end + 4)};
  }
  std::string body(const std::string& target) {
    const auto [head, text] = answer(target);
    EXPECT_THAT(head, HasSubstr(" 200 ")) << text;
    return text;
  }
  std::string finished(const v1::Simulation& simulation) {
    std::string name = bench_.create(simulation);
    EXPECT_TRUE(bench_.reaches(name, v1::Simulation::SUCCEEDED));
    return name;
  }
  std::string finished_history(int rows) {
    v1::Simulation simulation = point_simulation();
    v1::HistoryRequest* history = simulation.mutable_operating_point()->mutable_history();
    history->add_columns("mesh_force_newtons");
    history->add_columns("flank_load_newtons");
    history->set_mesh_cycles(10);
    history->set_samples_per_mesh_cycle(rows / 10);
    return finished(simulation);
  }
  /// The columns of a history, as its messages have them.
  Columns messages(const std::string& name, int max_points = 0) {
    v1::ReadHistoryRequest request;
    request.set_name(name);
    request.set_max_points(max_points);
    const auto source = read_history(app_, request).message();
    Columns out;
    v1::ReadHistoryResponse part;
    while (source->next(part) == AnyMessageSource::Step::kMessage) {
      if (part.has_schema()) out.resize(static_cast<std::size_t>(part.schema().columns_size()));
      if (!part.has_chunk()) continue;
      std::vector<double> values(part.chunk().values().size() / sizeof(double));
      std::memcpy(values.data(), part.chunk().values().data(), part.chunk().values().size());
      std::vector<double>& column = out[static_cast<std::size_t>(part.chunk().column())];
      column.insert(column.end(), values.begin(), values.end());
    }
    return out;
  }
  static Columns of_csv(const std::string& text, std::string& header) {
    std::istringstream lines(text);
    std::getline(lines, header);
    Columns out;
    for (std::string line; std::getline(lines, line);) {
      std::istringstream cells(line + ",");
      std::size_t place = 0;
      for (std::string cell; std::getline(cells, cell, ','); ++place) {
        if (out.size() <= place) out.emplace_back();
        out[place].push_back(cell.empty() ? NAN : std::stod(cell));
      }
    }
    return out;
  }
  /// Little-endian doubles from a place of a text on.
  static std::vector<double> doubles(const std::string& text, std::size_t begin) {
    std::vector<double> out((text.size() - begin) / sizeof(double));
    std::memcpy(out.data(), text.data() + begin, out.size() * sizeof(double));
    return out;
  }

  Bench bench_;
  Application app_ = bench_.application();
  CallDispatcher dispatcher_{app_};
  RestHandler handler_{dispatcher_};
  HttpServer server_{handler_, {"127.0.0.1", 0, ""}};
};

TEST_F(ColumnsTest, EveryFormOfAHistoryHasTheNumbersOfItsMessages) {
  const std::string name = finished_history(30'000);
  const std::string target = "/v1/" + name + ":readHistory";
  const std::string names =
      "mesh_force_newtons,flank_load_newtons_flank_0,flank_load_newtons_flank_1,flank_load_"
      "newtons_flank_2";
  for (const int points : {0, 1000}) {
    const Columns expected = messages(name, points);
    const std::string query = "?max_points=" + std::to_string(points) + "&alt=";
    std::string header;
    EXPECT_EQ(of_csv(body(target + query + "csv"), header), expected);
    EXPECT_EQ(header, names);
    const json columns = json::parse(body(target + query + "columns"));
    EXPECT_EQ(columns["columns"]["mesh_force_newtons"].get<std::vector<double>>(), expected[0]);
    EXPECT_EQ(columns["columns"]["flank_load_newtons_flank_2"].get<std::vector<double>>(),
              expected[3]);
    EXPECT_EQ(columns["units"]["mesh_force_newtons"], "N");
    EXPECT_EQ(columns["total_rows"], 30'000);
    EXPECT_EQ(columns["row_count"], expected[0].size());

    const std::string numpy = body(target + query + "npy");
    EXPECT_THAT(numpy, StartsWith("\x93NUMPY"));
    const std::size_t data = numpy.find('\n') + 1;
    EXPECT_EQ(data % 64, 0U);
    EXPECT_THAT(numpy.substr(0, data), HasSubstr("('mesh_force_newtons', '<f8')"));
    const std::vector<double> rows = doubles(numpy, data);
    ASSERT_EQ(rows.size(), 4 * expected[0].size());
    for (std::size_t i = 0; i < rows.size(); ++i) ASSERT_EQ(rows[i], expected[i % 4][i / 4]);

    const std::string binary = body(target + query + "binary");
    std::uint32_t length = 0;
    std::memcpy(&length, binary.data(), sizeof length);
    ASSERT_EQ((sizeof length + length) % sizeof(double), 0U);
    const json described = json::parse(binary.substr(sizeof length, length));
    EXPECT_EQ(described["columns"].size(), 4U);
    std::vector<double> one_after_another;
    for (const auto& column : expected) {
      one_after_another.insert(one_after_another.end(), column.begin(), column.end());
    }
    EXPECT_EQ(doubles(binary, sizeof length + length), one_after_another);
  }
}

TEST_F(ColumnsTest, RowsOfACampaignHaveTheSameForms) {
  v1::CreateCampaignRequest request;
  v1::Campaign& campaign = *request.mutable_campaign();
  campaign.set_lubricant("lubricants/paper-fluid-1");
  v1::CandidateColumn& column = *campaign.add_candidate_columns();
  column.set_path("surface.asperity_friction_coefficient");
  column.add_values(0.1);
  column.add_values(0.12);
  campaign.add_conditions()->set_speed_kilometres_per_hour(50);
  campaign.add_conditions()->set_speed_kilometres_per_hour(110);
  const std::string name = create_campaign(app_, request).message().name();
  v1::GetCampaignRequest get;
  get.set_name(name);
  ASSERT_TRUE(eventually(
      [&] { return get_campaign(app_, get).message().state() == v1::Campaign::SUCCEEDED; }));
  const std::string target = "/v1/" + name +
                             ":read?columns=candidate&columns=speed_kilometres_per_hour&"
                             "columns=mesh_loss_power_watts&start_row=1&alt=";
  std::string header;
  const Columns rows = of_csv(body(target + "csv"), header);
  EXPECT_EQ(header, "candidate,speed_kilometres_per_hour,mesh_loss_power_watts");
  EXPECT_THAT(rows.at(0), ElementsAre(0, 1, 1));
  EXPECT_THAT(rows.at(1), ElementsAre(110, 50, 110));
  const json columns = json::parse(body(target + "columns"));
  EXPECT_EQ(columns["columns"]["mesh_loss_power_watts"].get<std::vector<double>>(), rows[2]);
  EXPECT_EQ(columns["units"]["mesh_loss_power_watts"], "W");
  EXPECT_EQ(columns["total_rows"], 4);
  const std::string numpy = body(target + "npy");
  EXPECT_EQ(doubles(numpy, numpy.find('\n') + 1),
            (std::vector<double>{0, 110, rows[2][0], 1, 50, rows[2][1], 1, 110, rows[2][2]}));
  EXPECT_THAT(body(target + "ndjson"), StartsWith(R"({"result":{"schema":)"));
}

TEST_F(ColumnsTest, AHistoryIsReadInPartAndByAccept) {
  const std::string target = "/v1/" + finished_history(100) + ":readHistory";
  EXPECT_EQ(body(target + "?columns=mesh_force_newtons&start_row=7&row_count=2&alt=csv"),
            "mesh_force_newtons\n7\n8\n");
  EXPECT_EQ(body(target + "?columns=mesh_force_newtons&start_row=100&alt=csv"),
            "mesh_force_newtons\n");
  EXPECT_EQ(json::parse(body(target + "?start_row=100"))["columns"]["mesh_force_newtons"],
            json::array());
  EXPECT_THAT(answer(target, "Accept: text/csv\r\n").first,
              HasSubstr("Content-Type: text/csv; charset=utf-8"));
  EXPECT_THAT(answer(target, "Accept: application/x-npy\r\n").second, StartsWith("\x93NUMPY"));
  EXPECT_THAT(answer(target + "?columns=mesh_forces").first, StartsWith("HTTP/1.0 400"));
}

TEST_F(ColumnsTest, ACurveHasTheNumbersOfItsPoints) {
  const std::string name = finished(curve_simulation());
  const v1::Simulation curve = bench_.get(name);
  std::string header;
  const Columns csv = of_csv(body("/v1/" + name + "?alt=csv"), header);
  EXPECT_THAT(header, StartsWith("speed_kilometres_per_hour,"));
  EXPECT_THAT(header, HasSubstr(",inefficiency_rms_percent,"));
  EXPECT_THAT(header, HasSubstr(",minimum_film_ratio,mean_film_ratio,maximum_film_ratio,"));
  const std::string chosen = "speed_kilometres_per_hour,inefficiency_rms_percent";
  const Columns two = of_csv(body("/v1/" + name + "?alt=csv&columns=" + chosen), header);
  EXPECT_EQ(header, chosen);
  ASSERT_EQ(two[0].size(), static_cast<std::size_t>(curve.result().points_size()));
  for (std::size_t i = 0; i < two[0].size(); ++i) {
    const v1::CurvePoint& point = curve.result().points(static_cast<int>(i));
    EXPECT_EQ(two[0][i], point.speed_kilometres_per_hour());
    EXPECT_EQ(two[1][i], point.result().inefficiency_rms_percent());
  }
  const json columns = json::parse(body("/v1/" + name + "?alt=columns&columns=" + chosen));
  EXPECT_EQ(columns["columns"]["inefficiency_rms_percent"].get<std::vector<double>>(), two[1]);
  const std::string numpy = body("/v1/" + name + "?alt=npy&columns=" + chosen);
  EXPECT_EQ(doubles(numpy, numpy.find('\n') + 1)[1], two[1][0]);
  EXPECT_THAT(answer("/v1/" + name + "?alt=csv&columns=sped").second, HasSubstr("has no column"));
  EXPECT_THAT(answer("/v1/" + name + "?alt=csv&view=x").second,
              HasSubstr("takes the parameters alt and columns"));
  EXPECT_THAT(answer("/v1/simulations/77?alt=csv").first, StartsWith("HTTP/1.0 404"));
  const std::string head = answer("/v1/" + name + "?alt=csv").first;
  const std::string tag = head.substr(head.find("ETag: ") + 6, 66);
  EXPECT_THAT(answer("/v1/" + name + "?alt=csv", "If-None-Match: " + tag + "\r\n").first,
              StartsWith("HTTP/1.0 304"));
}

TEST_F(ColumnsTest, ATableIsReadInRangesOfItsBytes) {
  const std::string curve = "/v1/" + finished(curve_simulation()) + "?alt=";
  const std::string history = "/v1/" + finished_history(30'000) + ":readHistory?alt=";
  for (const std::string& target :
       {curve + "csv", curve + "npy", curve + "columns", history + "npy", history + "binary",
        history + "npy&max_points=100&columns=mesh_force_newtons",
        history + "npy&start_row=30000"}) {
    const auto [head, whole] = answer(target);
    const std::string length = std::to_string(whole.size());
    EXPECT_THAT(head, HasSubstr("Accept-Ranges: bytes")) << target;
    EXPECT_THAT(head, HasSubstr("Content-Length: " + length)) << target;
    const std::string tag = head.substr(head.find("ETag: ") + 6, 66);
    const std::size_t size = whole.size();
    const std::vector<std::tuple<std::string, std::size_t, std::size_t>> ranges = {
        {"0-0", 0, 1},
        {"10-", 10, size},
        {"-7", size - 7, size},
        {"-999999999", 0, size},
        {std::to_string(size / 3) + "-" + std::to_string(size / 2), size / 3, size / 2 + 1},
        {"5-999999999", 5, size}};
    for (const auto& [range, begin, end] : ranges) {
      const auto [part_head, part] =
          answer(target, "Range: bytes=" + range + "\r\nIf-Range: " + tag + "\r\n");
      EXPECT_THAT(part_head, StartsWith("HTTP/1.0 206")) << target << " " << range;
      EXPECT_THAT(part_head, HasSubstr("Content-Range: bytes " + std::to_string(begin) + "-" +
                                       std::to_string(end - 1) + "/" + length + "\r\n"));
      EXPECT_THAT(part_head, HasSubstr("Content-Length: " + std::to_string(end - begin)));
      EXPECT_TRUE(part == whole.substr(begin, end - begin)) << target << " " << range;
    }
    const auto [behind, error] = answer(target, "Range: bytes=" + length + "-\r\n");
    EXPECT_THAT(behind, StartsWith("HTTP/1.0 416")) << target;
    EXPECT_THAT(behind, HasSubstr("Content-Range: bytes */" + length + "\r\n"));
    EXPECT_THAT(error, HasSubstr("the body has " + length + " bytes"));
    EXPECT_THAT(answer(target, "Range: bytes=-0\r\n").first, StartsWith("HTTP/1.0 416"));
    const std::string other = "If-Range: \"" + std::string(64, '0') + "\"\r\n";
    for (const std::string& ignored :
         {"Range: bytes=0-1\r\n" + other, "Range: bytes=0-1\r\nIf-Range: W/" + tag + "\r\n",
          std::string("Range: bytes=0-1,4-5\r\n"), std::string("Range: rows=0-1\r\n"),
          std::string("Range: bytes=2-1\r\n"), std::string("Range: bytes=a-\r\n")}) {
      const auto [same_head, same] = answer(target, ignored);
      EXPECT_THAT(same_head, StartsWith("HTTP/1.0 200")) << target << " " << ignored;
      EXPECT_TRUE(same == whole) << target << " " << ignored;
    }
    const auto [known, nothing] =
        answer(target, "Range: bytes=0-1\r\nIf-None-Match: " + tag + "\r\n");
    EXPECT_THAT(known, StartsWith("HTTP/1.0 304")) << target;
    EXPECT_EQ(nothing, "");
  }
  for (const char* form : {"csv", "columns", "ndjson"}) {
    EXPECT_THAT(answer(history + form, "Range: bytes=0-1\r\n").first, StartsWith("HTTP/1.0 200"))
        << "its length is not known before its end";
  }
  const auto [zipped, bytes] = answer(curve + "csv", "Accept-Encoding: gzip\r\n");
  EXPECT_THAT(zipped, HasSubstr("ETag: W/\"")) << "other bytes than those of ranges";
  EXPECT_THAT(answer(curve + "csv", "Accept-Encoding: gzip\r\nRange: bytes=0-2000\r\n").first,
              Not(HasSubstr("Content-Encoding")));
}

TEST_F(ColumnsTest, HistoriesOfOtherInputsOrOtherRowsHaveOtherTags) {
  const auto tag = [&](const std::string& name, const std::string& query) {
    const std::string head = answer("/v1/" + name + ":readHistory?alt=" + query).first;
    return head.substr(head.find("ETag: ") + 6, 66);
  };
  const std::string first = finished_history(100), second = finished_history(200);
  EXPECT_EQ(tag(first, "npy"), tag(first, "npy"));
  EXPECT_NE(tag(first, "npy"), tag(first, "binary"));
  EXPECT_NE(tag(first, "npy"), tag(first, "npy&start_row=1"));
  EXPECT_NE(tag(first, "npy"), tag(first, "npy&columns=mesh_force_newtons"));
  EXPECT_NE(tag(first, "npy"), tag(second, "npy&row_count=100"));
}

TEST(ColumnText, WritesNumbersThatReadBackAndGapsAsSuch) {
  const Columns columns = {{0.1, NAN}, {1e300, -INFINITY}};
  EXPECT_EQ(csv_rows(columns), "0.1,1e+300\n,-inf\n");
  std::string text;
  append_json_number(NAN, text);
  append_json_number(-INFINITY, text);
  append_json_number(1.0 / 3, text);
  EXPECT_EQ(text, "null\"-Infinity\"0.3333333333333333");
}

}  // namespace
}  // namespace tribodyn::server
