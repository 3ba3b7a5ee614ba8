"""Linear algebra of matrices with as many rows as a system has states: two to ten.

For so few LAPACK takes most of its time to be called, and numba seconds to compile each call.
"""

from math import exp, log

import numpy as np

from wedgesweep.compiled import allocating

# Squarings of a matrix after which the norm of its power tells the spectral radius to 1e-8.
SQUARINGS = 32


@allocating
def places_of(chosen):
    """Indices of what is chosen: of the true ones of an array, or a tuple, of booleans."""
    places, count = np.empty(len(chosen), np.int64), 0
    for i in range(len(chosen)):
        if chosen[i]:
            places[count] = i
            count += 1
    return places[:count]


@allocating
def inverted(matrix):
    """Inverse of a matrix (n, n), which is overwritten; not finite if it is singular.

    By Gauss and Jordan's method, largest pivots first.
    """
    n = matrix.shape[0]
    inverse = np.zeros((n, n))
    for i in range(n):
        inverse[i, i] = 1.0
    for k in range(n):
        largest = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[largest, k]):
                largest = i
        pivot = matrix[largest, k]
        for j in range(n):
            matrix[largest, j], matrix[k, j] = matrix[k, j], matrix[largest, j] / pivot
            inverse[largest, j], inverse[k, j] = inverse[k, j], inverse[largest, j] / pivot
        for i in range(n):
            factor = matrix[i, k]
            if i != k:
                for j in range(n):
                    matrix[i, j] -= factor * matrix[k, j]
                    inverse[i, j] -= factor * inverse[k, j]
    return inverse


@allocating
def spectral_radius(matrix):
    """Largest modulus of the eigenvalues of a matrix (n, n): the limit of |A^k|^(1/k) (Gelfand)."""
    n = matrix.shape[0]
    power, squared = matrix.copy(), np.empty((n, n))
    logarithm, weight = 0.0, 1.0
    for _ in range(SQUARINGS):
        size = 0.0
        for i in range(n):
            for j in range(n):
                size = max(size, abs(power[i, j]))
        if size == 0.0:
            return 0.0
        logarithm += weight * log(size)
        weight *= 0.5
        for i in range(n):
            for j in range(n):
                total = 0.0
                for k in range(n):
                    total += power[i, k] * power[k, j]
                squared[i, j] = total / (size * size)
        power, squared = squared, power
    return exp(logarithm)
