#pragma once
/// How alike two segments look, by their descriptors.

#include <vector>

namespace plumb::loops_descriptor {

enum class Similarity {
  inverse_difference,  ///< [Tang2024] eq. 1, guarded
  equation_1,          ///< [Tang2024] eq. 1 as printed, with a floor under its differences
  cosine,              ///< a.b / (|a| |b|)
  chi_square,          ///< 1 - sum (a - b)^2 / (a + b) / sum (a + b); for histograms
};

/// 1 for equal descriptors, else less; the same both ways; 0 where nothing can be compared (but for
/// equation_1 all bins empty in both). All numbers are expected to be finite, and not negative.
/// Throws Error when the lengths differ.
///
/// inverse_difference: [Tang2024] eq. 1 is 1/K sum_k w_k / |a_k - b_k|, w_k = 1 - k/K, k = 1 .. K,
/// which is infinite where two bins agree, and many ESF bins are 0 in both. Ours: sum w_k epsilon /
/// (|a_k - b_k| + epsilon) / sum w_k over the bins that are not empty in both. `epsilon` is the
/// difference that counts as agreement (the noise of the descriptor's own sampling).
///
/// equation_1: the printed sum over all bins, those that are empty in both as well, its
/// denominators no less than `epsilon`, times 2 K epsilon / (K - 1), a constant that makes it 1 for
/// equal descriptors: sum w_k epsilon / max(|a_k - b_k|, epsilon) / sum w_k. Order and ratios are
/// those of the print. For a small `epsilon` it is the weighted share of the bins that agree
/// exactly.
double similarity(const std::vector<float>& a, const std::vector<float>& b, Similarity measure,
                  double epsilon);

}  // namespace plumb::loops_descriptor
