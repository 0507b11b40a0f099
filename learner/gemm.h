// SPDX-License-Identifier: Apache-2.0
// The matrix product of BLAS (learner/blas.h).
#pragma once

// In Fortran's calling convention, column-major.
extern "C" void sgemm_(const char* transpose_a, const char* transpose_b, const int* m, const int* n,
                       const int* k, const float* alpha, const float* a, const int* lda,
                       const float* b, const int* ldb, const float* beta, float* c, const int* ldc);

namespace corridor::learner {

// C[m, n] (column-major) = op(A) op(B), or += with `beta` 1.
inline void multiply(char transpose_a, char transpose_b, int m, int n, int k, const float* a,
                     int lda, const float* b, int ldb, float* c, int ldc, float beta = 0.0F) {
  const float alpha = 1.0F;
  sgemm_(&transpose_a, &transpose_b, &m, &n, &k, &alpha, a, &lda, b, &ldb, &beta, c, &ldc);
}

}  // namespace corridor::learner
