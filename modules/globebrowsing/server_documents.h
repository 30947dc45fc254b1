#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "globebrowsing/map_servers.h"
#include "globebrowsing/network/fetcher.h"

namespace meridian::globebrowsing {

/// The documents of a map server: its own, and those that lists name (a TMS's root, the folders of an ArcGIS server),
/// with the layers that they have. Decides which are to be fetched; fetches none. One thread at a time.
class ServerDocuments {
 public:
  /// Lists are followed so deep: a TMS has servers of services of maps, ArcGIS folders of services.
  static constexpr int deepestList = 2;
  /// So many documents are loaded besides the server's own.
  static constexpr std::size_t mostDocuments = 256;

  struct Wanted {
    std::size_t number = 0;  ///< for put()
    std::string url{};
  };
  /// Entries of a document that was read: layers of its own, and documents that it names, in their order.
  struct Entry {
    OfferedLayer layer{};
    std::string document{};  ///< an address; empty: it is `layer`
    std::string title{};     ///< of the document
  };
  /// What a document at `url` has. Takes long: what assets say of each layer is made, too. From any thread. Errors:
  /// parseCapabilities'; there is none.
  [[nodiscard]] static Result<std::vector<Entry>> read(const Fetched& document, const std::string& url,
                                                       const std::string& globe);

  /// Its own document is number 0, and wanted from the beginning.
  explicit ServerDocuments(const MapServer& server);

  /// What became of a document; returns what is to be fetched because of it.
  [[nodiscard]] std::vector<Wanted> put(std::size_t number, Result<std::vector<Entry>> entries);
  /// Whether there is nothing that was wanted and has not been put.
  [[nodiscard]] bool isComplete() const { return open_ == 0; }
  /// The layers of all documents in the order of the lists, and what is missing. `late` says why those that were not
  /// put are. Errors: those of its own document.
  [[nodiscard]] MapServers::Offer offer(const std::string& late);

 private:
  struct Document {
    std::string url;
    std::string title{};
    int depth = 0;
    bool isPut = false;
    Result<std::vector<Entry>> entries{};
    std::vector<std::size_t> listed{};  ///< of each entry that is followed, in order
  };
  void gather(std::size_t number, std::vector<OfferedLayer>& layers);
  [[nodiscard]] std::string missing(const std::string& late) const;

  std::vector<Document> documents_;
  std::set<std::string> known_;
  std::size_t open_ = 1;
  std::size_t tooDeep_ = 0;
  std::size_t tooMany_ = 0;
  std::size_t unreachable_ = 0;  ///< files named by an address of no server
};

}  // namespace meridian::globebrowsing
