#pragma once
/// The tables of the index, and whether they are as they were written.

#include <string>

#include "plumb/store/database.hpp"

namespace plumb {

void make_tables(Database& database);

/// False for a database whose maker was ended before it had made them.
bool has_tables(Database& database);

/// What is wrong with the database: its pages, its tables, or a row whose checksum does not fit; ""
/// when nothing is. Throws DatabaseError.
std::string damage_in(Database& database);

}  // namespace plumb
