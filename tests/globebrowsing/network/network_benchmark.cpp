// Tiles a second from a local nginx: through HttpFetcher (cache off), and through curl_multi alone with the same number
// of connections, in the same process. Their ratio is what the queue, the sharing and the deliveries cost.

#include <atomic>
#include <cstdint>
#include <fstream>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <curl/curl.h>

#include "globebrowsing/network/http_fetcher.h"
#include "support/nginx_server.h"

namespace meridian::globebrowsing {
namespace {

constexpr int tiles = 2000;
constexpr std::size_t tileBytes = 12'000;  // of a JPEG of 256 x 256 pixels

NginxServer& server() {
  static const auto nginx = [] {
    auto made = std::make_unique<NginxServer>();
    for (int i = 0; i < tiles; ++i) {
      std::ofstream(made->root() / (std::to_string(i) + ".jpg")) << std::string(tileBytes, static_cast<char>(i));
    }
    return made;
  }();
  return *nginx;
}

std::string base(benchmark::State& state) {
  return state.range(0) == 0 ? server().http1() : server().http2();
}

std::string tileUrl(const std::string& base, int i) {
  return base + "/" + std::to_string(i) + ".jpg";
}

void fetcher(benchmark::State& state) {
  NetworkOptions options;
  options.certificateFile = server().authority();
  const std::string from = base(state);
  HttpFetcher http(options);
  for (auto _ : state) {
    std::atomic<int> left{tiles};
    std::atomic<int> failures{0};
    std::vector<std::unique_ptr<PendingFetch>> pending;
    pending.reserve(tiles);
    for (int i = 0; i < tiles; ++i) {
      pending.push_back(http.fetch({.url = tileUrl(from, i)}, [&](const Result<Fetched>& answer) {
        failures += answer && answer->body->size() == tileBytes ? 0 : 1;
        if (--left == 0) {
          left.notify_one();
        }
      }));
    }
    for (int now = left; now != 0; now = left) {
      left.wait(now);
    }
    pending.clear();
    if (failures > 0) {
      state.SkipWithError("a tile did not come");
    }
  }
  state.SetItemsProcessed(state.iterations() * tiles);
}

std::size_t append(char* data, std::size_t, std::size_t size, void* body) {
  auto& bytes = *static_cast<std::vector<std::uint8_t>*>(body);
  bytes.insert(bytes.end(), data, data + size);
  return size;
}

void curlAlone(benchmark::State& state) {
  const std::string from = base(state);
  const std::string authority = server().authority();
  const bool isEncrypted = from.substr(0, 5) == "https";
  const std::size_t atOnce = isEncrypted ? 32 : 8;
  CURLM* multi = curl_multi_init();
  std::vector<CURL*> handles(atOnce);
  std::vector<std::vector<std::uint8_t>> bodies(atOnce);
  for (auto _ : state) {
    int next = 0;
    const auto start = [&](std::size_t slot) {
      CURL* easy = handles[slot] = handles[slot] == nullptr ? curl_easy_init() : handles[slot];
      curl_easy_setopt(easy, CURLOPT_URL, tileUrl(from, next++).c_str());
      curl_easy_setopt(easy, CURLOPT_NOSIGNAL, 1L);
      curl_easy_setopt(easy, CURLOPT_CAINFO, authority.c_str());
      curl_easy_setopt(easy, CURLOPT_CAPATH, nullptr);
      curl_easy_setopt(easy, CURLOPT_PIPEWAIT, isEncrypted ? 1L : 0L);
      curl_easy_setopt(easy, CURLOPT_WRITEFUNCTION, &append);
      curl_easy_setopt(easy, CURLOPT_WRITEDATA, &bodies[slot]);
      curl_easy_setopt(easy, CURLOPT_PRIVATE, reinterpret_cast<void*>(slot));
      bodies[slot].clear();
      curl_multi_add_handle(multi, easy);
    };
    for (std::size_t slot = 0; slot < atOnce; ++slot) {
      start(slot);
    }
    for (int done = 0; done < tiles;) {
      int running = 0;
      curl_multi_perform(multi, &running);
      int left = 0;
      while (const CURLMsg* message = curl_multi_info_read(multi, &left)) {
        std::size_t slot = 0;
        curl_easy_getinfo(message->easy_handle, CURLINFO_PRIVATE, &slot);
        if (message->data.result != CURLE_OK || bodies[slot].size() != tileBytes) {
          state.SkipWithError("a tile did not come");
        }
        curl_multi_remove_handle(multi, handles[slot]);
        ++done;
        if (next < tiles) {
          start(slot);
        }
      }
      if (done < tiles) {
        curl_multi_poll(multi, nullptr, 0, 100, nullptr);
      }
    }
  }
  for (CURL* easy : handles) {
    curl_easy_cleanup(easy);
  }
  curl_multi_cleanup(multi);
  state.SetItemsProcessed(state.iterations() * tiles);
}

// 0: HTTP/1.1, 8 connections. 1: HTTP/2 over TLS, 32 streams.
BENCHMARK(fetcher)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(curlAlone)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace meridian::globebrowsing
