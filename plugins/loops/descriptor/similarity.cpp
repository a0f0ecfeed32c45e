#include "similarity.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "plumb/data/error.hpp"

namespace plumb::loops_descriptor {
namespace {

double inverse_difference(const std::vector<float>& a, const std::vector<float>& b,
                          double epsilon) {
  double sum = 0, weights = 0;
  const auto bins = static_cast<double>(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (a[k] == 0 && b[k] == 0) continue;
    const double weight = 1 - static_cast<double>(k + 1) / bins;
    sum += weight * epsilon / (std::abs(static_cast<double>(a[k]) - b[k]) + epsilon);
    weights += weight;
  }
  return weights > 0 ? sum / weights : 0;
}

double equation_1(const std::vector<float>& a, const std::vector<float>& b, double epsilon) {
  double sum = 0, weights = 0;
  const auto bins = static_cast<double>(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double weight = 1 - static_cast<double>(k + 1) / bins;
    const double difference = std::abs(static_cast<double>(a[k]) - static_cast<double>(b[k]));
    sum += weight * epsilon / std::max(difference, epsilon);
    weights += weight;
  }
  return weights > 0 ? sum / weights : 0;
}

double cosine(const std::vector<float>& a, const std::vector<float>& b) {
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double x = a[k], y = b[k];
    ab += x * y, aa += x * x, bb += y * y;
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

double chi_square(const std::vector<float>& a, const std::vector<float>& b) {
  double different = 0, total = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double x = a[k], y = b[k];
    if (x + y > 0) different += (x - y) * (x - y) / (x + y);
    total += x + y;
  }
  return total > 0 ? 1 - different / total : 0;
}

}  // namespace

double similarity(const std::vector<float>& a, const std::vector<float>& b, Similarity measure,
                  double epsilon) {
  if (a.size() != b.size())
    throw Error("descriptors of " + std::to_string(a.size()) + " and " + std::to_string(b.size()) +
                " numbers cannot be compared: describe all segments in the same way");
  switch (measure) {
    case Similarity::inverse_difference:
      return inverse_difference(a, b, epsilon);
    case Similarity::equation_1:
      return equation_1(a, b, epsilon);
    case Similarity::cosine:
      return cosine(a, b);
    case Similarity::chi_square:
      return chi_square(a, b);
  }
  return 0;
}

}  // namespace plumb::loops_descriptor
