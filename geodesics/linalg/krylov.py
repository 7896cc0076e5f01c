"""A block Krylov basis that is kept orthogonal only as far as it has to be."""

from __future__ import annotations

import numpy as np
import scipy.linalg

from geodesics.arrays import Floats

NOTHING = 1e-20  # length of an image beside the longest that is none: a bound, far below what rounding leaves
_LONGEST = 6  # steps without reorthogonalisation. Not sensitive: 2 to 20 give the same eigenvalues to 5e-15 of the last
_SHARE = (
    3  # a third of the capacity is allocated first, which is usually enough. Not sensitive: 1 to 5 take the same time
)


class KrylovBasis:
    """Columns that span b, M b, M^2 b, ... for a symmetric M and a random block b, and M in this basis.

    Three-term recurrences lose orthogonality towards converged eigenvectors at a steady pace. It is enough that inner
    products stay below the root of the rounding error (Simon 1984): every few steps the last two blocks are
    made orthogonal to all before them in one matrix product, and the size of what is subtracted decides how soon the
    next time must be.
    """

    def __init__(self, n: int, block: int, capacity: int, loss: float) -> None:
        """Room for `capacity` columns of length n, whose inner products stay at about `loss` or below."""
        self.size = 0
        """Columns whose images have been taken in."""
        self._block, self._capacity, self._loss = block, capacity, loss
        self._random = np.random.default_rng(0)
        self._columns = np.empty((n, capacity // _SHARE + 2 * block), order="F")
        self._columns[:, :block] = np.linalg.qr(self._random.standard_normal((n, block)))[0]
        self._projected = np.zeros((capacity + block, capacity + block))  # block tridiagonal, lower half
        self._link = np.zeros((block, block))
        self._since, self._period, self._longest = 0, 2, 0.0

    def room(self) -> bool:
        """True while there is room for another block."""
        return self.size + self._block <= self._capacity

    @property
    def last(self) -> Floats:
        """The last block (n, b), whose image `grow` takes."""
        return self._columns[:, self.size : self.size + self._block]

    def grow(self, image: Floats) -> None:
        """Extend the basis by the image (n, b) of the last block; the image is overwritten."""
        b, before = self._block, self.size
        self.size += b
        if self.size + b > self._columns.shape[1]:
            wider = np.empty((len(image), self._capacity + b), order="F")
            wider[:, : self.size] = self._columns[:, : self.size]
            self._columns = wider
        length = np.linalg.norm(image, axis=0).max()
        near = self._columns[:, max(before - b, 0) : self.size]
        overlap = _removed(image, near)
        overlap += _removed(image, near)
        self._projected[before : self.size, before : self.size] = overlap[-b:]
        block, self._link = self._orthonormal(image, length)
        self._columns[:, self.size : self.size + b] = block
        self._projected[self.size : self.size + b, before : self.size] = self._link
        self._since += 1
        if self._since >= self._period and before > 0:
            self._reorthogonalise()

    def ritz(self, first: int, last: int) -> tuple[Floats, Floats, Floats]:
        """Approximate eigenvalues first to last, descending, their coordinates (size, k) and residuals (b, k)."""
        m, b = self.size, self._block
        values, coordinates = scipy.linalg.eigh(
            self._projected[:m, :m], subset_by_index=(m - last, m - first - 1), driver="evr", lower=True
        )
        values, coordinates = values[::-1], coordinates[:, ::-1]
        return values, coordinates, self._link @ coordinates[-b:]

    def vectors(self, values: Floats, coordinates: Floats, rest: Floats) -> Floats:
        """Eigenvectors (n, k) after one more power of M, which costs nothing, and orthonormal to rounding."""
        vectors = self._columns[:, : self.size + self._block] @ np.vstack([coordinates, rest / values])
        overlap = vectors.T @ vectors
        return np.asarray(vectors @ (1.5 * np.eye(len(values)) - 0.5 * overlap))  # the root of its inverse

    def _reorthogonalise(self) -> None:
        """Make the last two blocks orthogonal to all before, and decide when to do so again."""
        b, size = self._block, self.size
        pair = self._columns[:, size - b : size + b]
        lost = np.abs(_removed(pair, self._columns[:, : size - b])).max()
        _removed(pair[:, b:], pair[:, :b])
        try:
            pair[:, b:] = _factored(pair[:, b:])[0]
        except np.linalg.LinAlgError:
            pair[:, b:] = np.linalg.qr(pair[:, b:])[0]
        eps = np.finfo(float).eps
        pace = max(np.log(lost / eps) / self._since, 1e-3) if lost > eps else 1e-3
        longest = min(self._period + 1, _LONGEST)
        self._period, self._since = int(np.clip(np.log(self._loss / eps) / pace, 1, longest)), 0

    def _orthonormal(self, image: Floats, length: float) -> tuple[Floats, Floats]:
        """The image as an orthonormal block times a triangular factor; `length` is what it had before."""
        self._longest = max(self._longest, length)
        nothing = NOTHING * self._longest
        try:
            if length <= nothing:
                raise np.linalg.LinAlgError
            block, link = _factored(image)
            new = np.diag(link).min() / length
            if new > 1e-6:
                self._since = self._period if new < 1e-3 else self._since  # this much orthogonality is lost in one step
                again, tidy = _factored(block)
                return again, tidy @ link
        except np.linalg.LinAlgError:
            pass
        # nearly dependent: orthogonalise what is left, and replace columns without anything left by random ones
        basis = self._columns[:, : self.size]
        _removed(image, basis)
        block, link = np.linalg.qr(image)
        lost = np.abs(np.diag(link)) <= max(1e-13 * length, nothing, np.finfo(float).tiny)
        block[:, lost] = self._random.standard_normal((len(image), np.count_nonzero(lost)))
        for _ in range(2):
            _removed(block, basis)
            block = np.linalg.qr(block)[0]
        self._since = self._period
        return block, block.T @ image


def _removed(block: Floats, basis: Floats) -> Floats:
    """Subtract from the block, in place, its projection onto the basis; returns the coefficients."""
    coefficients = basis.T @ block
    block -= (coefficients.T @ basis.T).T  # in the order of the block, by columns
    return np.asarray(coefficients)


def _factored(block: Floats) -> tuple[Floats, Floats]:
    """A block as orthonormal columns times an upper triangle, by Cholesky; `LinAlgError` where they are dependent."""
    link = np.asarray(np.linalg.cholesky(block.T @ block).T, dtype=np.float64)
    return scipy.linalg.blas.dtrsm(1.0, link, block, side=1), link
