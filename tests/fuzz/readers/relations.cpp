#include "relations.hpp"

#include "../finite.hpp"
#include "../fuzz.hpp"

using namespace plumb;

PLUMB_FUZZ_READER(relations) {
  const RelationsFile file = read_relations(fuzz::file_of(bytes));
  for (const TrueRelation& relation : file.relations)
    fuzz::require(is_finite(relation.T_from_to), "relations that were read are finite");
}
