#include "localization/warp/warp_system.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "core/angle.hpp"
#include "localization/warp/cubic_basis.hpp"

namespace madori::localization {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Solver = Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<int>>;

constexpr int kStencil = 7;  ///< control points that share a place lie within three of each other
constexpr int kBox = kStencil * kStencil;
constexpr int kHalfBox = kBox / 2;
/// Of the similarity: shift along x and y (metres), size and turn: a drawing laid by its walls is off by
/// less.
const Eigen::Vector4d kSimilaritySigma(0.5, 0.5, 0.015, 0.03);

struct Touched {
  int node;
  double weight;
};

std::vector<Touched> nodes_at(const WarpLattice& lattice, const Point2<Map>& p) {
  std::vector<Touched> touched;
  if (lattice.nodes() == 0) return touched;
  visit_controls(lattice.width, lattice.height, (p.x_m - lattice.origin.x_m) / lattice.spacing_m,
                 (p.y_m - lattice.origin.y_m) / lattice.spacing_m,
                 [&](int node, double weight, double, double) {
                   touched.push_back({node, weight});
                 });
  return touched;
}

/// The displacement along the normal by (t_x, t_y, a, b).
Eigen::Vector4d similarity_row(const WarpObservation& o, const Point2<Map>& pivot) {
  const double dx = o.place.x_m - pivot.x_m;
  const double dy = o.place.y_m - pivot.y_m;
  return {o.normal_x, o.normal_y, o.normal_x * dx + o.normal_y * dy, -o.normal_x * dy + o.normal_y * dx};
}

/// Matern precision of one component at amplitude 1: K'K / (4 pi kappa^2 h^2), K = kappa^2 h^2 + the
/// lattice's Laplacian, zero beyond the lattice (Lindgren, Rue, Lindstroem 2011, alpha = 2).
class Matern {
 public:
  Matern(const WarpLattice& lattice, double range_m) : lattice_(lattice) {
    const double kappa_h = std::sqrt(8.0) / range_m * lattice.spacing_m;
    mass_ = kappa_h * kappa_h;
    factor_ = 1.0 / (4.0 * kPi * mass_);
  }
  /// Calls visit(q, entry of row p); a q may come again, the entries add.
  template <class Visit>
  void for_each_entry(int p, Visit&& visit) const {
    for_each_k(p, [&](int r, double k_pr) {
      for_each_k(r, [&](int q, double k_rq) { visit(q, factor_ * k_pr * k_rq); });
    });
  }
  [[nodiscard]] double log_determinant() const {
    double sum = 0.0;
    for (int j = 1; j <= lattice_.height; ++j)
      for (int i = 1; i <= lattice_.width; ++i)
        sum += 2.0 * std::log(mass_ + 4.0 - 2.0 * std::cos(kPi * i / (lattice_.width + 1)) -
                              2.0 * std::cos(kPi * j / (lattice_.height + 1)));
    return sum + lattice_.nodes() * std::log(factor_);
  }
  /// c' Q1 c of one component, whose control points are `c` and then every one.
  [[nodiscard]] double quadratic(const double* c) const {
    double sum = 0.0;
    for (int p = 0; p < lattice_.nodes(); ++p) {
      double k = 0.0;
      for_each_k(p, [&](int q, double k_pq) { k += k_pq * c[q]; });
      sum += k * k;
    }
    return factor_ * sum;
  }

 private:
  template <class Visit>
  void for_each_k(int p, Visit&& visit) const {
    const int column = p % lattice_.width;
    const int row = p / lattice_.width;
    if (row > 0) visit(p - lattice_.width, -1.0);
    if (column > 0) visit(p - 1, -1.0);
    visit(p, mass_ + 4.0);
    if (column + 1 < lattice_.width) visit(p + 1, -1.0);
    if (row + 1 < lattice_.height) visit(p + lattice_.width, -1.0);
  }

  WarpLattice lattice_;
  double mass_;
  double factor_;
};

/// The normal equations while they are summed up, lower triangle: x, y of the control points, offsets,
/// similarity.
class Normal {
 public:
  Normal(const WarpLattice& lattice, int units, bool similarity)
      : lattice_(lattice), nodes_(lattice.nodes()), units_(units), similarity_(similarity ? 4 : 0) {
    const auto boxes = static_cast<std::size_t>(nodes_) * kBox;
    for (auto& block : blocks_) block.assign(boxes, 0.0);
    couplings_.resize(static_cast<std::size_t>(units));
    offsets_ = Eigen::VectorXd::Zero(units);
    mixed_ = Eigen::MatrixXd::Zero(4, 2 * nodes_ + units);
    right_ = Eigen::VectorXd::Zero(size());
  }
  [[nodiscard]] int size() const { return 2 * nodes_ + units_ + similarity_; }
  [[nodiscard]] const Eigen::VectorXd& right() const { return right_; }

  void add_prior(const Matern& matern, const WarpPriorWeights& prior) {
    const double precision = 1.0 / (prior.amplitude_m * prior.amplitude_m);
    for (int p = 0; p < nodes_; ++p)
      matern.for_each_entry(p, [&](int q, double entry) {
        blocks_[0][slot(p, q)] += precision * entry;
        blocks_[2][slot(p, q)] += precision * entry;
      });
    for (int k = 0; k < units_; ++k) offsets_[k] += prior.offset_precision[static_cast<std::size_t>(k)];
    own_ = kSimilaritySigma.array().square().inverse().matrix().asDiagonal();
  }

  void add(const WarpObservation& o, const Point2<Map>& pivot) {
    const std::vector<Touched> touched = nodes_at(lattice_, o.place);
    const double w = o.information;
    const double xx = w * o.normal_x * o.normal_x;
    const double xy = w * o.normal_x * o.normal_y;
    const double yy = w * o.normal_y * o.normal_y;
    const Eigen::Vector4d s = similarity_row(o, pivot);
    const int unit = 2 * nodes_ + o.unit;
    auto& coupling = couplings_[static_cast<std::size_t>(o.unit)];
    for (const Touched& p : touched) {
      for (const Touched& q : touched) {
        const std::size_t at = slot(p.node, q.node);
        const double product = p.weight * q.weight;
        blocks_[0][at] += xx * product;
        blocks_[1][at] += xy * product;
        blocks_[2][at] += yy * product;
      }
      const double px = w * p.weight * o.normal_x;
      const double py = w * p.weight * o.normal_y;
      coupling.push_back({p.node, px, py});
      mixed_.col(p.node) += px * s;
      mixed_.col(nodes_ + p.node) += py * s;
      right_[p.node] += px * o.distance_m;
      right_[nodes_ + p.node] += py * o.distance_m;
    }
    offsets_[o.unit] += w;
    mixed_.col(unit) += w * s;
    right_[unit] += w * o.distance_m;
    if (similarity_ > 0) right_.tail(4) += w * o.distance_m * s;
    own_ += w * s * s.transpose();
  }

  [[nodiscard]] Matrix matrix() {
    const std::vector<std::vector<Coupled>> by_node = couplings_by_node();
    Matrix m(size(), size());
    m.reserve(static_cast<Eigen::Index>(size()) * 40);
    for (int column = 0; column < size(); ++column) {
      m.startVec(column);
      if (column < 2 * nodes_)
        append_node(m, column, by_node);
      else if (column < 2 * nodes_ + units_)
        m.insertBack(column, column) = offsets_[column - 2 * nodes_];
      append_similarity(m, column);
    }
    m.finalize();
    return m;
  }

 private:
  struct Coupled {
    int other;
    double x;
    double y;
  };

  [[nodiscard]] std::size_t slot(int p, int q) const {
    const int rows = q / lattice_.width - p / lattice_.width;
    const int columns = q % lattice_.width - p % lattice_.width;
    return static_cast<std::size_t>(p * kBox + kHalfBox + rows * kStencil + columns);
  }
  [[nodiscard]] int neighbour(int p, int k) const {
    const int column = p % lattice_.width + k % kStencil - kStencil / 2;
    const int row = p / lattice_.width + k / kStencil - kStencil / 2;
    if (column < 0 || column >= lattice_.width || row < 0 || row >= lattice_.height) return -1;
    return row * lattice_.width + column;
  }

  std::vector<std::vector<Coupled>> couplings_by_node() {
    std::vector<std::vector<Coupled>> by_node(static_cast<std::size_t>(nodes_));
    for (int k = 0; k < units_; ++k) {
      auto& list = couplings_[static_cast<std::size_t>(k)];
      std::sort(list.begin(), list.end(),
                [](const Coupled& a, const Coupled& b) { return a.other < b.other; });
      for (const Coupled& c : list) {
        auto& at = by_node[static_cast<std::size_t>(c.other)];
        if (at.empty() || at.back().other != k) at.push_back({k, 0.0, 0.0});
        at.back().x += c.x;
        at.back().y += c.y;
      }
    }
    return by_node;
  }

  /// Neighbours within two stay even where they are zero: their covariance is wanted.
  [[nodiscard]] static bool is_kept(int k, double value) {
    return value != 0.0 || (std::abs(k % kStencil - 3) <= 2 && std::abs(k / kStencil - 3) <= 2);
  }

  void append_node(Matrix& m, int column, const std::vector<std::vector<Coupled>>& by_node) {
    const bool is_x = column < nodes_;
    const int p = is_x ? column : column - nodes_;
    const auto& own = blocks_[is_x ? 0 : 2];
    const int shift = is_x ? 0 : nodes_;
    for (int k = kHalfBox; k < kBox; ++k) {
      const int q = neighbour(p, k);
      const double value = own[static_cast<std::size_t>(p * kBox + k)];
      if (q >= 0 && is_kept(k, value)) m.insertBack(shift + q, column) = value;
    }
    for (int k = 0; is_x && k < kBox; ++k) {
      const int q = neighbour(p, k);
      const double value = blocks_[1][static_cast<std::size_t>(p * kBox + k)];
      if (q >= 0 && value != 0.0) m.insertBack(nodes_ + q, column) = value;
    }
    for (const Coupled& c : by_node[static_cast<std::size_t>(p)]) {
      const double value = is_x ? c.x : c.y;
      if (value != 0.0) m.insertBack(2 * nodes_ + c.other, column) = value;
    }
  }

  void append_similarity(Matrix& m, int column) {
    const int first = 2 * nodes_ + units_;
    for (int k = std::max(0, column - first); k < similarity_; ++k)
      m.insertBack(first + k, column) = column < first ? mixed_(k, column) : own_(k, column - first);
  }

  WarpLattice lattice_;
  int nodes_;
  int units_;
  int similarity_;
  std::array<std::vector<double>, 3> blocks_;  ///< xx, xy, yy: by node and place in the box around it
  std::vector<std::vector<Coupled>> couplings_;
  Eigen::VectorXd offsets_;
  Eigen::MatrixXd mixed_;
  Eigen::Matrix4d own_ = Eigen::Matrix4d::Zero();
  Eigen::VectorXd right_;
};

/// The elements of the inverse where the Cholesky factor has any (Takahashi, Fagan, Chen 1973).
class SelectedInverse {
 public:
  explicit SelectedInverse(const Solver& solver)
      : l_(solver.matrixL().nestedExpression()), order_(solver.permutationP().indices()) {
    const int n = static_cast<int>(l_.cols());
    const Eigen::VectorXd d = solver.vectorD();
    below_.assign(static_cast<std::size_t>(l_.nonZeros()), 0.0);
    diagonal_ = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd l = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(n);
    const int* start = l_.outerIndexPtr();
    const int* row = l_.innerIndexPtr();
    const double* value = l_.valuePtr();
    for (int j = n - 1; j >= 0; --j) {
      for (int t = start[j]; t < start[j + 1]; ++t) l[row[t]] = value[t];
      for (int t = start[j]; t < start[j + 1]; ++t) {
        const int c = row[t];
        const double l_c = l[c];
        double sum_c = diagonal_[c] * l_c;
        for (int s = start[c]; s < start[c + 1]; ++s) {
          const double z = below_[static_cast<std::size_t>(s)];
          sum[row[s]] += z * l_c;
          sum_c += z * l[row[s]];
        }
        sum[c] += sum_c;
      }
      double own = 1.0 / d[j];
      for (int t = start[j]; t < start[j + 1]; ++t) {
        below_[static_cast<std::size_t>(t)] = -sum[row[t]];
        own += value[t] * sum[row[t]];
      }
      diagonal_[j] = own;
      for (int t = start[j]; t < start[j + 1]; ++t) {
        const int c = row[t];
        l[c] = 0.0;
        sum[c] = 0.0;
        for (int s = start[c]; s < start[c + 1]; ++s) sum[row[s]] = 0.0;
      }
    }
  }
  /// Of the unknowns i and k; zero where the factor has no element.
  [[nodiscard]] double operator()(int i, int k) const {
    const auto [low, high] = std::minmax(order_[i], order_[k]);
    if (low == high) return diagonal_[low];
    const int* first = l_.innerIndexPtr() + l_.outerIndexPtr()[low];
    const int* last = l_.innerIndexPtr() + l_.outerIndexPtr()[low + 1];
    const int* found = std::lower_bound(first, last, high);
    if (found == last || *found != high) return 0.0;
    return below_[static_cast<std::size_t>(found - l_.innerIndexPtr())];
  }

 private:
  Matrix l_;
  Eigen::VectorXi order_;
  std::vector<double> below_;
  Eigen::VectorXd diagonal_;
};

}  // namespace

struct WarpPosterior::Parts {
  WarpLattice lattice;
  Point2<Map> pivot;
  WarpPriorWeights prior;
  int units = 0;
  Solver solver;
  Eigen::VectorXd z;
  Eigen::VectorXd right;
  std::unique_ptr<SelectedInverse> inverse;

  [[nodiscard]] int first_offset() const { return 2 * lattice.nodes(); }
  [[nodiscard]] int first_similarity() const { return first_offset() + units; }
};

WarpPosterior::~WarpPosterior() = default;
WarpPosterior::WarpPosterior(WarpPosterior&&) noexcept = default;
WarpPosterior& WarpPosterior::operator=(WarpPosterior&&) noexcept = default;

WarpPosterior::WarpPosterior(const WarpLattice& lattice, const Point2<Map>& pivot,
                             const std::vector<WarpObservation>& observations, const WarpPriorWeights& prior)
    : parts_(std::make_unique<Parts>()) {
  parts_->lattice = lattice;
  parts_->pivot = pivot;
  parts_->prior = prior;
  parts_->units = static_cast<int>(prior.offset_precision.size());
  Normal normal(lattice, parts_->units, prior.similarity);
  normal.add_prior(Matern(lattice, prior.range_m), prior);
  for (const WarpObservation& o : observations) normal.add(o, pivot);
  parts_->solver.compute(normal.matrix());
  parts_->right = normal.right();
  parts_->z = parts_->solver.solve(parts_->right);
}

Eigen::Vector2d WarpPosterior::control(int node) const {
  return {parts_->z[node], parts_->z[parts_->lattice.nodes() + node]};
}

double WarpPosterior::offset(int unit) const {
  return parts_->z[parts_->first_offset() + unit];
}

Eigen::Vector4d WarpPosterior::similarity() const {
  if (!parts_->prior.similarity) return Eigen::Vector4d::Zero();
  return parts_->z.tail<4>();
}

double WarpPosterior::roughness() const {
  const Matern matern(parts_->lattice, parts_->prior.range_m);
  return matern.quadratic(parts_->z.data()) + matern.quadratic(parts_->z.data() + parts_->lattice.nodes());
}

double WarpPosterior::occam_nats() const {
  const WarpPriorWeights& prior = parts_->prior;
  double nats = -0.5 * parts_->solver.vectorD().array().log().sum();
  if (prior.similarity) {
    const Eigen::Vector4d q = kSimilaritySigma.array().square().inverse();
    nats += 0.5 * q.array().log().sum() - 0.5 * similarity().dot(q.cwiseProduct(similarity()));
  }
  if (parts_->lattice.nodes() > 0) {
    const double variance = prior.amplitude_m * prior.amplitude_m;
    nats += Matern(parts_->lattice, prior.range_m).log_determinant() -
            parts_->lattice.nodes() * std::log(variance) - 0.5 * roughness() / variance;
  }
  return nats;
}

double WarpPosterior::log_marginal() const {
  double quadratic = 0.0;  // occam_nats() counts the field's and the similarity's, half of z' b all
  const WarpPriorWeights& prior = parts_->prior;
  if (parts_->lattice.nodes() > 0) quadratic += roughness() / (prior.amplitude_m * prior.amplitude_m);
  if (prior.similarity)
    quadratic +=
        similarity().dot(kSimilaritySigma.array().square().inverse().matrix().cwiseProduct(similarity()));
  double nats = occam_nats() + 0.5 * quadratic + 0.5 * parts_->z.dot(parts_->right);
  for (const double precision : prior.offset_precision) nats += 0.5 * std::log(precision);
  return nats;
}

void WarpPosterior::invert() {
  parts_->inverse = std::make_unique<SelectedInverse>(parts_->solver);
}

double WarpPosterior::offset_variance(int unit) const {
  const int i = parts_->first_offset() + unit;
  return (*parts_->inverse)(i, i);
}

double WarpPosterior::field_freedom() const {
  const int nodes = parts_->lattice.nodes();
  const Matern matern(parts_->lattice, parts_->prior.range_m);
  double trace = 0.0;
  for (int p = 0; p < nodes; ++p)
    matern.for_each_entry(p, [&](int q, double entry) {
      trace += entry * ((*parts_->inverse)(p, q) + (*parts_->inverse)(nodes + p, nodes + q));
    });
  return std::max(0.0, 2.0 * nodes - trace / (parts_->prior.amplitude_m * parts_->prior.amplitude_m));
}

double WarpPosterior::freedom() const {
  double freedom = parts_->lattice.nodes() > 0 ? field_freedom() : 0.0;
  for (int k = 0; k < parts_->units; ++k)
    freedom += 1.0 - parts_->prior.offset_precision[static_cast<std::size_t>(k)] * offset_variance(k);
  for (int k = 0; parts_->prior.similarity && k < 4; ++k) {
    const int i = parts_->first_similarity() + k;
    freedom += 1.0 - (*parts_->inverse)(i, i) / (kSimilaritySigma[k] * kSimilaritySigma[k]);
  }
  return freedom;
}

double WarpPosterior::variance_at(int node) const {
  const WarpLattice& lattice = parts_->lattice;
  const Point2<Map> place{lattice.origin.x_m + node % lattice.width * lattice.spacing_m,
                          lattice.origin.y_m + node / lattice.width * lattice.spacing_m};
  const std::vector<Touched> touched = nodes_at(lattice, place);
  const SelectedInverse& z = *parts_->inverse;
  double largest = 0.0;
  for (const bool is_x : {true, false}) {
    const int shift = is_x ? 0 : lattice.nodes();
    const WarpObservation axis{0, place, is_x ? 1.0 : 0.0, is_x ? 0.0 : 1.0, 0.0, 1.0};
    const Eigen::Vector4d s = similarity_row(axis, parts_->pivot);
    double variance = 0.0;
    for (const Touched& p : touched) {
      if (p.weight == 0.0) continue;
      for (const Touched& q : touched)
        if (q.weight != 0.0) variance += p.weight * q.weight * z(shift + p.node, shift + q.node);
      for (int k = 0; parts_->prior.similarity && k < 4; ++k)
        variance += 2.0 * p.weight * s[k] * z(shift + p.node, parts_->first_similarity() + k);
    }
    for (int k = 0; parts_->prior.similarity && k < 4; ++k)
      for (int m = 0; m < 4; ++m)
        variance += s[k] * s[m] * z(parts_->first_similarity() + k, parts_->first_similarity() + m);
    largest = std::max(largest, variance);
  }
  return largest;
}

}  // namespace madori::localization
