#include "sparse.h"

#include <cholmod.h>

#include <memory>
#include <utility>

namespace tartan_calib::solver {
namespace {

/// CHOLMOD's workspace and settings, and the ownership of what it allocates.
class Cholmod {
 public:
  Cholmod() {
    cholmod_start(&common_);
    common_.print = 0;
    common_.final_ll = 1;                     // LDL' would go on past an indefinite pivot
    common_.supernodal = CHOLMOD_SIMPLICIAL;  // no BLAS, whose threads may change the rounding
    common_.error_handler = nullptr;
  }
  ~Cholmod() { cholmod_finish(&common_); }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;

  cholmod_common* get() { return &common_; }

  template <typename T, int (*kFree)(T**, cholmod_common*)>
  auto own(T* raw) {
    const auto release = [this](T* p) { kFree(&p, &common_); };
    return std::unique_ptr<T, decltype(release)>(raw, release);
  }

 private:
  cholmod_common common_;
};

struct Entry {
  int row = 0;
  int col = 0;
  double value = 0.0;
};

/// The damped, unit-diagonal normal matrix (lower triangle) and right-hand side. Unknowns: shared, then block by block.
struct SparseSystem {
  std::vector<Entry> entries;
  Eigen::VectorXd scale;
  Eigen::VectorXd rhs;
};

Eigen::VectorXd scaling(const NormalEquations& equations) {
  const Eigen::Index num_shared = equations.g_s.size();
  Eigen::VectorXd scale(num_shared + kBlockSize * static_cast<Eigen::Index>(equations.blocks.size()));
  scale.head(num_shared) = dampingScale(equations.H_ss);
  Eigen::Index offset = num_shared;
  for (const BlockTerms& block : equations.blocks) {
    scale.segment<kBlockSize>(offset) = dampingScale(block.H_bb);
    offset += kBlockSize;
  }
  return scale.cwiseSqrt().cwiseInverse();
}

/// Adds scaled entries of the lower triangle; prescribed unknowns keep a diagonal of one only.
class EntryWriter {
 public:
  EntryWriter(const Prescribed& prescribed, double damping, SparseSystem& system)
      : prescribed_(prescribed), damping_(damping), system_(system) {}

  void add(Eigen::Index row, Eigen::Index col, double h) {
    const bool is_held = isPrescribed(row) || isPrescribed(col);
    if (row == col) {
      write(row, col, is_held ? 1.0 : system_.scale(row) * system_.scale(row) * h + damping_);
    } else if (!is_held && h != 0.0) {
      write(row, col, system_.scale(row) * system_.scale(col) * h);
    }
  }

 private:
  bool isPrescribed(Eigen::Index i) const {
    return i < prescribed_.step.size() && prescribed_.is_prescribed[static_cast<std::size_t>(i)];
  }
  void write(Eigen::Index row, Eigen::Index col, double value) {
    system_.entries.push_back({static_cast<int>(row), static_cast<int>(col), value});
  }

  const Prescribed& prescribed_;
  double damping_;
  SparseSystem& system_;
};

SparseSystem assemble(const NormalEquations& equations, double damping, const Prescribed& prescribed) {
  const Eigen::Index num_shared = equations.g_s.size();
  SparseSystem system;
  system.scale = scaling(equations);
  system.rhs.resize(system.scale.size());
  system.rhs.head(num_shared) = -(equations.g_s + equations.H_ss * prescribed.step);

  EntryWriter writer(prescribed, damping, system);
  for (Eigen::Index col = 0; col < num_shared; ++col) {
    for (Eigen::Index row = col; row < num_shared; ++row) {
      writer.add(row, col, equations.H_ss(row, col));
    }
  }
  Eigen::Index offset = num_shared;
  for (const BlockTerms& block : equations.blocks) {
    system.rhs.segment<kBlockSize>(offset) = -(block.g_b + timesShared(block, prescribed.step));
    for (Eigen::Index row = 0; row < kBlockSize; ++row) {
      for (std::size_t i = 0; i < block.shared.size(); ++i) {
        writer.add(offset + row, block.shared[i], block.H_bs(row, static_cast<Eigen::Index>(i)));
      }
      for (Eigen::Index col = 0; col <= row; ++col) {
        writer.add(offset + row, offset + col, block.H_bb(row, col));
      }
    }
    offset += kBlockSize;
  }
  system.rhs.array() *= system.scale.array();
  return system;
}

std::optional<Eigen::VectorXd> factorAndSolve(const SparseSystem& system) {
  Cholmod cholmod;
  cholmod_common* common = cholmod.get();
  const std::size_t size = static_cast<std::size_t>(system.rhs.size());
  constexpr int kLowerTriangle = -1;

  const auto triplets = cholmod.own<cholmod_triplet, cholmod_free_triplet>(
      cholmod_allocate_triplet(size, size, system.entries.size(), kLowerTriangle, CHOLMOD_REAL, common));
  for (std::size_t i = 0; i < system.entries.size(); ++i) {
    static_cast<int*>(triplets->i)[i] = system.entries[i].row;
    static_cast<int*>(triplets->j)[i] = system.entries[i].col;
    static_cast<double*>(triplets->x)[i] = system.entries[i].value;
  }
  triplets->nnz = system.entries.size();
  const auto matrix = cholmod.own<cholmod_sparse, cholmod_free_sparse>(
      cholmod_triplet_to_sparse(triplets.get(), system.entries.size(), common));
  const auto factor = cholmod.own<cholmod_factor, cholmod_free_factor>(cholmod_analyze(matrix.get(), common));
  cholmod_factorize(matrix.get(), factor.get(), common);
  if (common->status != CHOLMOD_OK || factor->minor < size) {
    return std::nullopt;
  }
  const auto rhs =
      cholmod.own<cholmod_dense, cholmod_free_dense>(cholmod_allocate_dense(size, 1, size, CHOLMOD_REAL, common));
  Eigen::Map<Eigen::VectorXd>(static_cast<double*>(rhs->x), system.rhs.size()) = system.rhs;
  const auto solution =
      cholmod.own<cholmod_dense, cholmod_free_dense>(cholmod_solve(CHOLMOD_A, factor.get(), rhs.get(), common));
  return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(solution->x), system.rhs.size()));
}

}  // namespace

std::optional<Step> solveSparse(const NormalEquations& equations, double damping, const Prescribed& prescribed) {
  const SparseSystem system = assemble(equations, damping, prescribed);
  const std::optional<Eigen::VectorXd> scaled = factorAndSolve(system);
  if (!scaled) {
    return std::nullopt;
  }
  const Eigen::VectorXd solution = scaled->cwiseProduct(system.scale);
  const Eigen::Index num_shared = equations.g_s.size();
  Step step{prescribed.step, {}};
  for (const int i : prescribed.freeIndices()) {
    step.shared(i) = solution(i);
  }
  step.blocks.reserve(equations.blocks.size());
  for (std::size_t k = 0; k < equations.blocks.size(); ++k) {
    step.blocks.emplace_back(solution.segment<kBlockSize>(num_shared + kBlockSize * static_cast<Eigen::Index>(k)));
  }
  return step;
}

}  // namespace tartan_calib::solver
