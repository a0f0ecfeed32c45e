#include "relations.hpp"

#include "../finite.hpp"
#include "../fuzz.hpp"

using namespace plumb;

PLUMB_FUZZ_READER(relations) {
  const measure_relations::RelationsFile file =
      measure_relations::read_relations(fuzz::file_of(bytes));
  for (const measure_relations::TrueRelation& relation : file.relations)
    fuzz::require(is_finite(relation.T_from_to), "relations that were read are finite");
}
