#pragma once
/// The tables of the index: made, filled from the results, and whether they are as they were
/// written.

#include <filesystem>
#include <string>

#include "plumb/store/database.hpp"

namespace plumb {

/// Writes a row of a result: its key, step, bytes, and when it was made and last used.
inline constexpr const char* put_result =
    "INSERT OR REPLACE INTO results VALUES(?1, ?2, ?3, ?4, ?5, row_sum(?1, ?2, ?3, ?4, ?5))";

void make_tables(Database& database);

/// False for a database whose maker was ended before it had made them.
bool has_tables(Database& database);

/// What is wrong with the database: its pages, its tables, or a row whose checksum does not fit; ""
/// when nothing is. Throws DatabaseError.
std::string damage_in(Database& database);

/// Gives rows to the results of a store that have none, and takes those away that have no result.
/// Throws DatabaseError.
void follow_files(Database& database, const std::filesystem::path& store);

}  // namespace plumb
