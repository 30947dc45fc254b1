#include "globebrowsing/network/sqlite_database.h"

#include <sqlite3.h>

namespace meridian::globebrowsing {

namespace {

/// A file as SQLite's URI; what has a meaning in one is encoded.
std::string uriOf(const std::filesystem::path& file, std::string_view query) {
  std::string uri = "file:";
  for (const char letter : file.string()) {
    switch (letter) {
      case '%':
        uri += "%25";
        break;
      case '?':
        uri += "%3f";
        break;
      case '#':
        uri += "%23";
        break;
      default:
        uri += letter;
    }
  }
  return uri.append(query);
}

}  // namespace

int SqliteDatabase::open(const std::filesystem::path& file, Access access) {
  close();
  int flags = SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_URI;
  flags |= access == Access::Write ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READONLY;
  const std::string uri = uriOf(file, access == Access::Immutable ? "?immutable=1" : "");
  const int code = sqlite3_open_v2(uri.c_str(), &database_, flags, nullptr);
  if (code == SQLITE_OK) {
    sqlite3_extended_result_codes(database_, 0);
    sqlite3_busy_timeout(database_, 1000);
  }
  return code;
}

void SqliteDatabase::close() {
  for (const auto& [text, statement] : statements_) {
    sqlite3_finalize(statement);
  }
  statements_.clear();
  sqlite3_close(database_);
  database_ = nullptr;
}

bool SqliteDatabase::isReadOnly() const {
  return database_ != nullptr && sqlite3_db_readonly(database_, "main") == 1;
}

std::string SqliteDatabase::lastMessage() const {
  return database_ == nullptr ? "out of memory" : sqlite3_errmsg(database_);
}

int SqliteDatabase::run(const char* statements) {
  return sqlite3_exec(database_, statements, nullptr, nullptr, nullptr);
}

int SqliteDatabase::prepared(const char* text, sqlite3_stmt** statement) {
  if (const auto known = statements_.find(text); known != statements_.end()) {
    *statement = known->second;
    return SQLITE_OK;
  }
  const int code = sqlite3_prepare_v3(database_, text, -1, SQLITE_PREPARE_PERSISTENT, statement, nullptr);
  if (code == SQLITE_OK) {
    statements_.emplace(text, *statement);
  }
  return code;
}

SqliteDatabase::Statement::Statement(SqliteDatabase& database, const char* text)
    : statement_(nullptr), failure_(database.prepared(text, &statement_)) {}

SqliteDatabase::Statement::~Statement() {
  if (statement_ != nullptr) {
    sqlite3_reset(statement_);
    sqlite3_clear_bindings(statement_);
  }
}

SqliteDatabase::Statement& SqliteDatabase::Statement::bind(int place, std::int64_t value) {
  if (failure_ == SQLITE_OK) {
    failure_ = sqlite3_bind_int64(statement_, place, value);
  }
  return *this;
}

SqliteDatabase::Statement& SqliteDatabase::Statement::bind(int place, std::string_view text) {
  if (failure_ == SQLITE_OK) {
    failure_ = sqlite3_bind_text64(statement_, place, text.data(), text.size(), SQLITE_STATIC, SQLITE_UTF8);
  }
  return *this;
}

SqliteDatabase::Statement& SqliteDatabase::Statement::bind(int place, const std::vector<std::uint8_t>& blob) {
  if (failure_ == SQLITE_OK) {
    // An empty vector's data may be null, which SQLite would store as NULL.
    failure_ = blob.empty() ? sqlite3_bind_zeroblob(statement_, place, 0)
                            : sqlite3_bind_blob64(statement_, place, blob.data(), blob.size(), SQLITE_STATIC);
  }
  return *this;
}

int SqliteDatabase::Statement::step() {
  return failure_ == SQLITE_OK ? sqlite3_step(statement_) : failure_;
}

std::int64_t SqliteDatabase::Statement::integer(int column) const {
  return sqlite3_column_int64(statement_, column);
}

std::string SqliteDatabase::Statement::text(int column) const {
  const auto* data = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
  return data == nullptr ? std::string()
                         : std::string(data, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column)));
}

std::vector<std::uint8_t> SqliteDatabase::Statement::blob(int column) const {
  const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(statement_, column));
  return data == nullptr ? std::vector<std::uint8_t>()
                         : std::vector<std::uint8_t>(data, data + sqlite3_column_bytes(statement_, column));
}

}  // namespace meridian::globebrowsing
