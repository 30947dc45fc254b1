#include "globebrowsing/network/disk_cache.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include <sqlite3.h>

#include "host/api/log.h"

namespace meridian::globebrowsing {

namespace {

namespace fs = std::filesystem;

/// What an entry costs besides its body: its row, its place in two indices, its share of pages half full.
constexpr std::uint64_t entryOverhead = 512;
constexpr std::size_t usesPerWrite = 512;

constexpr const char* habits = R"sql(
  PRAGMA synchronous = NORMAL;
  PRAGMA journal_size_limit = 16777216;
  PRAGMA trusted_schema = OFF;
  PRAGMA cell_size_check = ON;
)sql";

// Bodies have a table of their own, so that noting a use does not write the body again.
constexpr const char* tables = R"sql(
  PRAGMA auto_vacuum = INCREMENTAL;
  PRAGMA journal_mode = WAL;
  CREATE TABLE IF NOT EXISTS entries(
    id INTEGER PRIMARY KEY,
    key TEXT NOT NULL UNIQUE,
    fields TEXT NOT NULL,
    request_time INTEGER NOT NULL,
    response_time INTEGER NOT NULL,
    bytes INTEGER NOT NULL,
    used INTEGER NOT NULL);
  CREATE INDEX IF NOT EXISTS entries_by_use ON entries(used, bytes);
  CREATE TABLE IF NOT EXISTS bodies(id INTEGER PRIMARY KEY, body BLOB NOT NULL);
  PRAGMA user_version = 1;
)sql";

bool isDamage(int code) {
  return code == SQLITE_CORRUPT || code == SQLITE_NOTADB;
}

}  // namespace

DiskCache::DiskCache(CacheOptions options, NetworkStatistics& statistics)
    : options_(std::move(options)), statistics_(&statistics) {}

DiskCache::~DiskCache() {
  close();
}

fs::path DiskCache::fileIn(const fs::path& folder) {
  return folder / "http-1.sqlite";  // the number is the tables' version
}

void DiskCache::setMode(CacheMode mode) {
  if (mode != options_.mode) {
    close();
    options_.mode = mode;
    state_ = State::Unopened;
  }
}

void DiskCache::setMaximumBytes(std::uint64_t bytes) {
  if (options_.maximumBytes == 0 && bytes > 0) {
    state_ = State::Unopened;
  }
  options_.maximumBytes = bytes;
  if (canWrite()) {
    evict();
    commit();
  }
}

std::optional<CachedAnswer> DiskCache::find(const std::string& key) {
  if (!canRead()) {
    return std::nullopt;
  }
  std::optional<CachedAnswer> found;
  int code = SQLITE_DONE;
  std::int64_t id = 0;
  {
    SqliteDatabase::Statement select(database_,
                                     "SELECT id, fields, request_time, response_time, body FROM entries JOIN bodies "
                                     "USING(id) WHERE key = ?");
    code = select.bind(1, key).step();
    if (code == SQLITE_ROW) {
      id = select.integer(0);
      found.emplace();
      found->facts = {HeaderFields::fromText(select.text(1)), select.integer(2), select.integer(3)};
      found->body = std::make_shared<const std::vector<std::uint8_t>>(select.blob(4));
    }
  }
  if (!holds(code, false) || !found) {
    return std::nullopt;
  }
  if (state_ == State::Writing) {
    used_.push_back(id);
    if (used_.size() >= usesPerWrite) {
      beginWrite();
      commit();
    }
  }
  return found;
}

void DiskCache::store(const std::string& key, const CachedAnswer& answer) {
  const std::string fields = relevantFields(answer.facts.fields).text();
  const std::uint64_t bytes = answer.body->size() + key.size() + fields.size() + entryOverhead;
  if (bytes > options_.maximumBytes / 4 || !canWrite()) {
    return;
  }
  remove(key);
  beginWrite();
  if (state_ != State::Writing) {
    return;
  }
  int code = SQLITE_OK;
  {
    SqliteDatabase::Statement insert(database_,
                                     "INSERT INTO entries(key, fields, request_time, response_time, bytes, used) "
                                     "VALUES(?, ?, ?, ?, ?, ?) RETURNING id");
    insert.bind(1, key).bind(2, fields).bind(3, answer.facts.requestTime).bind(4, answer.facts.responseTime);
    code = insert.bind(5, static_cast<std::int64_t>(bytes)).bind(6, ++uses_).step();
    if (code == SQLITE_ROW) {
      SqliteDatabase::Statement body(database_, "INSERT OR REPLACE INTO bodies(id, body) VALUES(?, ?)");
      code = body.bind(1, insert.integer(0)).bind(2, *answer.body).step();
    }
  }
  if (holds(code, true)) {
    bytes_ += bytes;
    ++statistics_->stored;
    evict();
  }
}

void DiskCache::refresh(const std::string& key, const AnswerFacts& facts) {
  if (!canWrite()) {
    return;
  }
  beginWrite();
  const std::string fields = relevantFields(facts.fields).text();
  int code = SQLITE_OK;
  {
    SqliteDatabase::Statement update(
        database_, "UPDATE entries SET fields = ?, request_time = ?, response_time = ? WHERE key = ?");
    code = update.bind(1, fields).bind(2, facts.requestTime).bind(3, facts.responseTime).bind(4, key).step();
  }
  holds(code, true);
}

void DiskCache::remove(const std::string& key) {
  if (!canWrite()) {
    return;
  }
  std::int64_t id = 0;
  std::int64_t bytes = 0;
  int code = SQLITE_OK;
  {
    SqliteDatabase::Statement select(database_, "SELECT id, bytes FROM entries WHERE key = ?");
    code = select.bind(1, key).step();
    if (code == SQLITE_ROW) {
      id = select.integer(0);
      bytes = select.integer(1);
    }
  }
  if (!holds(code, false) || code != SQLITE_ROW) {
    return;
  }
  beginWrite();
  erase(id);
  bytes_ -= std::min(bytes_, static_cast<std::uint64_t>(std::max<std::int64_t>(bytes, 0)));
}

void DiskCache::commit() {
  if (!inTransaction_) {
    return;
  }
  writeUses();
  if (inTransaction_) {
    inTransaction_ = false;
    holds(database_.run("COMMIT"), true);
  }
  statistics_->cacheBytes = bytes_;
}

bool DiskCache::canRead() {
  if (state_ == State::Unopened) {
    open();
  }
  return state_ == State::Writing || state_ == State::Reading;
}

bool DiskCache::canWrite() {
  return options_.mode == CacheMode::ReadWrite && canRead() && state_ == State::Writing;
}

void DiskCache::open() {
  state_ = State::Unusable;
  if (options_.mode == CacheMode::Off || options_.folder.empty() || options_.maximumBytes == 0) {
    return;
  }
  const fs::path file = fileIn(options_.folder);
  std::error_code problem;
  if (options_.mode != CacheMode::ReadWrite) {
    const int code = fs::exists(file, problem) ? openForReading(file) : SQLITE_OK;
    if (code != SQLITE_OK) {
      degrade(State::Unusable, reason(code), "start once with the cache mode read-write, or delete it");
    }
    return;
  }

  fs::create_directories(options_.folder, problem);
  int code = openForWriting(file);
  if (isDamage(code)) {
    startAnew(file);
  } else if (code == SQLITE_OK) {
    state_ = State::Writing;
    evict();
    commit();
  } else {
    const std::string what = problem ? problem.message() : reason(code);
    const bool isHeld = code == SQLITE_BUSY || code == SQLITE_LOCKED;
    const bool isReadable = openForReading(file) == SQLITE_OK;
    degrade(isReadable ? State::Reading : State::Unusable, what,
            isHeld ? "end that program" : "make that folder writable, or name another one");
  }
}

/// Leaves the state at Reading, or closed.
int DiskCache::openForReading(const fs::path& file) {
  int code = SQLITE_OK;
  // A medium that cannot be written at all has no place for the files that readers of a WAL share.
  for (const auto access : {SqliteDatabase::Access::Read, SqliteDatabase::Access::Immutable}) {
    code = database_.open(file, access);
    if (code == SQLITE_OK) {
      SqliteDatabase::Statement first(database_, "SELECT id FROM entries LIMIT 1");
      code = first.step();
    }
    if (code == SQLITE_ROW || code == SQLITE_DONE) {
      state_ = State::Reading;
      return SQLITE_OK;
    }
    if (code == SQLITE_BUSY || code == SQLITE_LOCKED) {
      break;  // it is no such medium
    }
  }
  return code;
}

int DiskCache::openForWriting(const fs::path& file) {
  if (const int code = database_.open(file, SqliteDatabase::Access::Write); code != SQLITE_OK) {
    return code;
  }
  if (database_.isReadOnly()) {
    return SQLITE_READONLY;
  }
  if (const int code = database_.run(habits); code != SQLITE_OK) {
    return code;
  }
  bool isNew = false;
  {
    SqliteDatabase::Statement version(database_, "PRAGMA user_version");
    if (const int code = version.step(); code != SQLITE_ROW) {
      return code;
    }
    isNew = version.integer(0) == 0;
  }
  // Making what is there already would wait for others that write.
  if (const int code = isNew ? database_.run(tables) : SQLITE_OK; code != SQLITE_OK) {
    return code;
  }
  SqliteDatabase::Statement sums(database_, "SELECT COALESCE(SUM(bytes), 0), COALESCE(MAX(used), 0) FROM entries");
  const int code = sums.step();
  if (code != SQLITE_ROW) {
    return code;
  }
  bytes_ = static_cast<std::uint64_t>(std::max<std::int64_t>(sums.integer(0), 0));
  uses_ = sums.integer(1);
  return SQLITE_OK;
}

/// Sets a damaged database aside, over the last one that was, and makes an empty one.
void DiskCache::startAnew(const fs::path& file) {
  database_.close();
  inTransaction_ = false;
  used_.clear();
  bytes_ = 0;
  if (std::exchange(wasDamaged_, true)) {
    degrade(State::Unusable, "it was damaged twice", "check the disk, or name another folder");
    return;
  }
  fs::path aside = file;
  aside += ".damaged";
  std::error_code problem;
  fs::rename(file, aside, problem);
  for (const char* companion : {"-wal", "-shm"}) {
    fs::path other = file;
    other += companion;
    std::error_code ignored;
    fs::remove(other, ignored);
  }
  if (!problem && openForWriting(file) == SQLITE_OK) {
    state_ = State::Writing;
    log::warning("{}: the cache of downloads was damaged and starts anew; {} can be deleted", file.string(),
                 aside.string());
  } else {
    degrade(State::Unusable, "it is damaged, and cannot be replaced", "delete it");
  }
}

void DiskCache::close() {
  if (state_ == State::Writing && !used_.empty()) {
    beginWrite();
  }
  commit();
  database_.close();
  state_ = State::Unusable;
}

void DiskCache::beginWrite() {
  if (!inTransaction_ && state_ == State::Writing) {
    inTransaction_ = true;
    if (!holds(database_.run("BEGIN IMMEDIATE"), true)) {
      inTransaction_ = false;
    }
  }
}

void DiskCache::erase(std::int64_t id) {
  for (const char* text : {"DELETE FROM entries WHERE id = ?", "DELETE FROM bodies WHERE id = ?"}) {
    if (state_ != State::Writing) {
      return;
    }
    int code = SQLITE_OK;
    {
      SqliteDatabase::Statement statement(database_, text);
      code = statement.bind(1, id).step();
    }
    holds(code, true);
  }
}

void DiskCache::writeUses() {
  const std::vector<std::int64_t> used = std::exchange(used_, {});
  for (const std::int64_t id : used) {
    if (state_ != State::Writing || !inTransaction_) {
      return;
    }
    int code = SQLITE_OK;
    {
      SqliteDatabase::Statement update(database_, "UPDATE entries SET used = ? WHERE id = ?");
      code = update.bind(1, ++uses_).bind(2, id).step();
    }
    holds(code, true);
  }
}

void DiskCache::evict() {
  if (bytes_ <= options_.maximumBytes) {
    return;
  }
  beginWrite();
  writeUses();
  const std::uint64_t target = options_.maximumBytes / 10 * 9;
  // Other programs may have stored or dropped entries meanwhile.
  bytes_ = static_cast<std::uint64_t>(std::max<std::int64_t>(number("SELECT SUM(bytes) FROM entries"), 0));
  while (bytes_ > target && state_ == State::Writing) {
    std::vector<std::pair<std::int64_t, std::uint64_t>> oldest;
    {
      SqliteDatabase::Statement select(database_, "SELECT id, bytes FROM entries ORDER BY used LIMIT 256");
      while (select.step() == SQLITE_ROW) {
        oldest.emplace_back(select.integer(0),
                            static_cast<std::uint64_t>(std::max<std::int64_t>(select.integer(1), 0)));
      }
    }
    if (oldest.empty()) {
      bytes_ = 0;
    }
    for (const auto& [id, bytes] : oldest) {
      if (bytes_ <= target) {
        break;
      }
      erase(id);
      bytes_ -= std::min(bytes_, bytes);
      ++statistics_->evicted;
    }
  }
  shrinkFile();
}

/// Pages that come free are used again; only a file that has become far too large for its budget is cut.
void DiskCache::shrinkFile() {
  const std::int64_t free = number("PRAGMA freelist_count") * number("PRAGMA page_size");
  if (state_ == State::Writing && free > static_cast<std::int64_t>(options_.maximumBytes / 4)) {
    holds(database_.run("PRAGMA incremental_vacuum"), true);
  }
}

/// The first column of the first row; -1 when there is none.
std::int64_t DiskCache::number(const char* query) {
  int code = SQLITE_DONE;
  std::int64_t value = -1;
  {
    SqliteDatabase::Statement statement(database_, query);
    code = statement.step();
    value = code == SQLITE_ROW ? statement.integer(0) : -1;
  }
  holds(code, false);
  return value;
}

bool DiskCache::holds(int code, bool isWrite) {
  if (code == SQLITE_OK || code == SQLITE_ROW || code == SQLITE_DONE) {
    return true;
  }
  if (isDamage(code) && state_ == State::Writing) {
    startAnew(fileIn(options_.folder));
  } else if (isDamage(code)) {
    degrade(State::Unusable, reason(code), "delete it, or start once with the cache mode read-write");
  } else if (code == SQLITE_FULL) {
    degrade(State::Reading, reason(code), "make room, or lower MERIDIAN_CACHE_SIZE");
  } else {
    const bool isHeld = code == SQLITE_BUSY || code == SQLITE_LOCKED;
    degrade(isWrite ? State::Reading : State::Unusable, reason(code),
            isHeld ? "end that program" : "check the disk, or name another folder");
  }
  return false;
}

std::string DiskCache::reason(int code) const {
  switch (code) {
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return "it is damaged";
    case SQLITE_FULL:
      return "the disk is full";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another program holds it";
    case SQLITE_READONLY:
      return "it cannot be written";
    default:
      return database_.lastMessage();
  }
}

void DiskCache::degrade(State state, const std::string& what, const std::string& remedy) {
  if (!std::exchange(hasComplained_, true)) {
    log::warning("{}: the cache of downloads {}: {}; {}", fileIn(options_.folder).string(),
                 state == State::Reading ? "is only read from now on" : "is not used", what, remedy);
  }
  if (inTransaction_) {
    inTransaction_ = false;
    database_.run("ROLLBACK");
  }
  used_.clear();
  state_ = state;
  if (state == State::Unusable) {
    database_.close();
  }
}

}  // namespace meridian::globebrowsing
