#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace meridian::globebrowsing {

/// An open SQLite database, for one thread. Results are SQLite's codes (SQLITE_OK, SQLITE_ROW, SQLITE_DONE, ...),
/// because what its user does about them depends on which it is.
class SqliteDatabase {
 public:
  SqliteDatabase() = default;
  SqliteDatabase(const SqliteDatabase&) = delete;
  SqliteDatabase& operator=(const SqliteDatabase&) = delete;
  ~SqliteDatabase() { close(); }

  enum class Access {
    Write,      ///< made when it is missing
    Read,       ///< must be there
    Immutable,  ///< as Read, on a medium that cannot be written at all; nobody else may write
  };
  int open(const std::filesystem::path& file, Access access);
  void close();
  [[nodiscard]] bool isOpen() const { return database_ != nullptr; }
  /// It was opened for writing, and cannot be written.
  [[nodiscard]] bool isReadOnly() const;
  [[nodiscard]] std::string lastMessage() const;

  /// Statements without results, parted by semicolons.
  int run(const char* statements);

  /// One prepared statement in use; it is reset when this goes.
  class Statement {
   public:
    Statement(SqliteDatabase& database, const char* text);
    Statement(const Statement&) = delete;
    Statement& operator=(const Statement&) = delete;
    ~Statement();

    // Parameters are counted from 1. What they point to must live as long as the statement.
    Statement& bind(int place, std::int64_t value);
    Statement& bind(int place, std::string_view text);
    Statement& bind(int place, const std::vector<std::uint8_t>& blob);
    /// SQLITE_ROW while there are rows, then SQLITE_DONE.
    int step();
    // Columns are counted from 0.
    [[nodiscard]] std::int64_t integer(int column) const;
    [[nodiscard]] std::string text(int column) const;
    [[nodiscard]] std::vector<std::uint8_t> blob(int column) const;

   private:
    sqlite3_stmt* statement_;
    int failure_;  ///< of preparing and binding
  };

 private:
  friend class Statement;
  int prepared(const char* text, sqlite3_stmt** statement);

  sqlite3* database_ = nullptr;
  std::unordered_map<const char*, sqlite3_stmt*> statements_;  ///< by the address of their text
};

}  // namespace meridian::globebrowsing
