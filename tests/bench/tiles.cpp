// Tiles a second from a server on this machine to decoded pixels in memory: ours, curl_multi and libjpeg-turbo alone,
// and GDAL's TMS driver, in turn in one process.
//   bench-tiles [--rounds N] [--only http|tls|http2|latency]
// Prints one JSON object.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "host/api/log.h"
#include "support/fault_server.h"
#include "support/jpeg_pyramid.h"
#include "support/nginx_server.h"
#include "tile_contestants.h"

namespace {

using namespace meridian;
using bench::Contest;
using bench::Decoders;
using bench::GdalSettings;
using bench::TileContestant;

constexpr int decodingThreads = 2;
constexpr int connections = 8;
constexpr int multiplexed = 32;
constexpr int gdalThreads = 4;
constexpr int distantConnections = 16;
constexpr auto latency = std::chrono::milliseconds(30);

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Tiles a second of some contestants, round by round.
class Rounds {
 public:
  /// `most`: rounds that a slow one takes part in.
  void add(std::string name, std::unique_ptr<TileContestant> contestant, int tiles, int most = 1000) {
    entries_.push_back({std::move(name), std::move(contestant), tiles, most, {}});
  }
  /// In turn, so that all see the machine in the same mood; the first round is not counted.
  void run(int rounds) {
    for (int round = 0; round <= rounds; ++round) {
      for (Entry& entry : entries_) {
        if (round > entry.most) {
          continue;
        }
        const double speed = entry.contestant->run(entry.tiles);
        if (round > 0) {
          entry.speeds.push_back(speed);
        }
      }
    }
  }
  /// "NAME": tiles a second, and what the first is of each other one: the medians.
  [[nodiscard]] std::string report() const {
    std::string text;
    for (const Entry& entry : entries_) {
      text += fmt::format("\"{}\": {:.1f}, ", entry.name, median(entry.speeds));
    }
    for (auto entry = entries_.begin() + 1; entry != entries_.end(); ++entry) {
      std::vector<double> ratios;
      for (std::size_t i = 0; i < entry->speeds.size(); ++i) {
        ratios.push_back(entries_.front().speeds[i] / entry->speeds[i]);
      }
      text += fmt::format("\"over_{}\": {:.3f}, ", entry->name, median(ratios));
    }
    return text.substr(0, text.size() - 2);
  }

 private:
  struct Entry {
    std::string name;
    std::unique_ptr<TileContestant> contestant;
    int tiles;
    int most;
    std::vector<double> speeds;
  };
  std::vector<Entry> entries_;
};

std::string contents(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// The system's authorities and the server's: as many as a user's program reads.
std::filesystem::path authorities(const NginxServer& server) {
  const std::filesystem::path file = server.root() / "authorities.pem";
  std::ofstream(file) << contents("/etc/ssl/certs/ca-certificates.crt") << contents(server.authority());
  return file;
}

std::string http(const NginxServer& server, Decoders& decoders, int rounds) {
  const Contest contest{server.http1(), connections, {}};
  Rounds contests;
  contests.add("meridian", meridianTiles(contest, decoders), 2048);
  contests.add("curl", curlTiles(contest, decoders), 2048);
  contests.add("gdal", gdalTiles(contest, {gdalThreads, true}), 256, 5);
  contests.run(rounds);
  return contests.report();
}

std::string tls(const NginxServer& server, Decoders& decoders, int rounds, bool isHttp2) {
  const Contest contest{isHttp2 ? server.http2() : server.http1OverTls(), isHttp2 ? multiplexed : connections,
                        authorities(server)};
  Rounds contests;
  contests.add("meridian", meridianTiles(contest, decoders), 2048);
  contests.add("curl", curlTiles(contest, decoders), 2048);
  contests.add("gdal", gdalTiles(contest, {gdalThreads, true}), 16, 3);
  contests.run(rounds);
  return contests.report();
}

/// Each answer comes 30 ms after its request; opening a connection costs nothing, to GDAL's advantage.
std::string distant(Decoders& decoders, int rounds) {
  FaultServer slow;
  slow.onAnything([body = JpegPyramid::tile()](const FaultServer::Request&) {
    std::this_thread::sleep_for(latency);
    return FaultServer::Reply{.headers = {"Content-Type: image/jpeg"}, .body = body};
  });
  const Contest contest{slow.url(""), distantConnections, {}};
  Rounds contests;
  contests.add("meridian", meridianTiles(contest, decoders), 512);
  contests.add("gdal", gdalTiles(contest, {1, false}), 32);
  contests.run(rounds);
  return contests.report();
}

}  // namespace

int main(int argc, char** argv) {
  int rounds = 7;
  std::string only;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (argv[i] == std::string("--rounds")) {
      rounds = std::max(1, std::atoi(argv[i + 1]));
    } else if (argv[i] == std::string("--only")) {
      only = argv[i + 1];
    }
  }
  log::setLevel(log::Level::Warning);
  ::setenv("no_proxy", "127.0.0.1,localhost", 1);
  try {
    const NginxServer server;
    JpegPyramid::write(server.root());
    Decoders decoders(decodingThreads);
    const auto wants = [&](const char* name) { return only.empty() || only == name; };
    std::string parts;
    const auto part = [&](const char* name, const std::string& report) {
      parts += fmt::format("{}\"{}\": {{{}}}", parts.empty() ? "" : ",\n ", name, report);
    };
    if (wants("http")) {
      part("http", http(server, decoders, rounds));
    }
    if (wants("tls")) {
      part("tls", tls(server, decoders, rounds, false));
    }
    if (wants("http2")) {
      part("http2", tls(server, decoders, rounds, true));
    }
    if (wants("latency")) {
      part("latency", distant(decoders, 3));
    }
    fmt::print("{{{}}}\n", parts);
  } catch (const std::exception& exception) {
    log::error("{}", exception.what());
    return 1;
  }
  return 0;
}
