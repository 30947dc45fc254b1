#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "globebrowsing/network/cache_policy.h"
#include "globebrowsing/network/network_options.h"
#include "globebrowsing/network/network_statistics.h"
#include "globebrowsing/network/sqlite_database.h"

namespace meridian::globebrowsing {

/// An answer as it is kept.
struct CachedAnswer {
  AnswerFacts facts;
  std::shared_ptr<const std::vector<std::uint8_t>> body;  ///< never null
};

/// Answers in an SQLite database (WAL), least recently used ones dropped above a budget of bytes. For one thread, which
/// may wait for the disk; several programs may share the database.
///
/// No fault is anybody's problem but its own: a database that is damaged is set aside and made anew, one that cannot be
/// written is only read, one that cannot be read is left alone; the log says so once, and what to do. What is not there
/// is simply not found. A process that ends in the middle of a write loses that write.
class DiskCache {
 public:
  /// Opens nothing yet; the statistics outlive it.
  DiskCache(CacheOptions options, NetworkStatistics& statistics);
  DiskCache(const DiskCache&) = delete;
  DiskCache& operator=(const DiskCache&) = delete;
  /// Commits.
  ~DiskCache();

  void setMode(CacheMode mode);
  void setMaximumBytes(std::uint64_t bytes);

  [[nodiscard]] std::optional<CachedAnswer> find(const std::string& key);
  /// Replaces what was there. Nothing larger than a quarter of the budget is kept.
  void store(const std::string& key, const CachedAnswer& answer);
  /// New facts of a body that stays.
  void refresh(const std::string& key, const AnswerFacts& facts);
  void remove(const std::string& key);
  /// Ends the transaction that the first write after the last commit has begun.
  void commit();

  /// The database below that folder.
  [[nodiscard]] static std::filesystem::path fileIn(const std::filesystem::path& folder);

 private:
  enum class State { Unopened, Writing, Reading, Unusable };

  [[nodiscard]] bool canRead();
  [[nodiscard]] bool canWrite();
  void open();
  int openForReading(const std::filesystem::path& file);
  int openForWriting(const std::filesystem::path& file);
  void startAnew(const std::filesystem::path& file);
  void close();
  void beginWrite();
  void erase(std::int64_t id);
  void writeUses();
  void evict();
  void shrinkFile();
  std::int64_t number(const char* query);
  /// Whether a statement went well; if not, draws the consequences.
  bool holds(int code, bool isWrite);
  [[nodiscard]] std::string reason(int code) const;
  void degrade(State state, const std::string& what, const std::string& remedy);

  CacheOptions options_;
  NetworkStatistics* statistics_;
  SqliteDatabase database_;
  State state_ = State::Unopened;
  bool inTransaction_ = false;
  bool wasDamaged_ = false;
  bool hasComplained_ = false;
  std::uint64_t bytes_ = 0;         ///< of all entries, as far as this program knows
  std::int64_t uses_ = 0;           ///< the greatest number of use so far
  std::vector<std::int64_t> used_;  ///< entries whose use is not written yet, in the order of use
};

}  // namespace meridian::globebrowsing
