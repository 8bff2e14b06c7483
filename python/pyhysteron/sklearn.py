"""pyhysteron for scikit-learn: a regressor with memory, and a splitter that respects the memory.

A column of `X` is the input; others may be the time and the load, for models that need them. The
rows are samples in the order of time, and the output depends on that order: shuffled rows are
another experiment. `predict` starts at the first row with every operator off (or on, with
``start='on'``; with ``'unknown'`` in the state that `fit` found). A plain `KFold` scores the wrong experiment, since it
passes the middle of a recording without its past. `BranchSplit` also passes what the operators
remember.
"""

from __future__ import annotations

import numbers
from collections.abc import Iterator
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

try:
    from sklearn.base import BaseEstimator, RegressorMixin
    from sklearn.utils.validation import check_array, check_is_fitted, validate_data
except ImportError as _missing:
    raise ImportError("pyhysteron.sklearn needs scikit-learn 1.6 or newer: pip install 'pyhysteron[sklearn]'") from _missing

from . import _hysteron

__all__ = ["EXPECTED_FAILED_CHECKS", "BranchSplit", "HysteresisRegressor"]

_MEMORY = "a model with memory depends on the order of the samples"

#: For ``check_estimator(HysteresisRegressor(), expected_failed_checks=EXPECTED_FAILED_CHECKS)``.
EXPECTED_FAILED_CHECKS = {
    "check_methods_sample_order_invariance": _MEMORY,
    "check_methods_subset_invariance": _MEMORY,
}


class HysteresisRegressor(RegressorMixin, BaseEstimator):
    """A hysteresis model as a regressor: `pyhysteron.fit` and `Model.simulate`.

    Parameters
    ----------
    levels : int or 'auto'
        Number of levels of the plane.
    range : tuple of float, optional
        Lowest and highest level; by default the active range is that of the input.
    operator : {'mkp', 'kp', 'relay'}
    solver : {'nnls', 'ols'}
    smooth : float, tuple of float, or 'auto'
        Strengths of the smoothness along the diagonal of the plane, and across it.
    ridge : float
        Pulls weights that the data hardly move to zero.
    robust : bool
        Whether outliers, which stand out from their neighbours, are found and left out of the fit.
    start : {'auto', 'off', 'on', 'rest', 'unknown'}
        State of the operators before the first sample. `fit` estimates 'unknown', and `predict`
        then starts where the model does: `pyhysteron.Model.fitted_start`, or every operator off.
    sign : {None, 1, -1}
    offset : float, optional
    bootstrap : int
        Replicates for `Model.confidence` and `Model.band` of ``model_``.
    hold_out : str, optional
        What takes no part in the fit, such as ``'branches:20%'`` or ``'rows:100-200'``. The errors
        there are in ``model_.fit.hold_out``. To test several parts in turn, use `BranchSplit`.
    column : int
        The column of `X` that is the input.
    time_column, load_column : int, optional
        The columns of `X` that are the time, s, and the load. Others are ignored.
    load_law, load_degree, spacing, delay, creep, lag, dynamics, curve, thermal
        As for `pyhysteron.fit`.

    Attributes
    ----------
    model_ : pyhysteron.Model
        Its input and output have the names of the columns, where `X` and `y` are of pandas.
    n_features_in_ : int
    feature_names_in_ : ndarray of str
        Only where `X` has names for its columns.

    Examples
    --------
    >>> import numpy as np
    >>> from pyhysteron.sklearn import HysteresisRegressor
    >>> t = np.linspace(0, 20, 400)
    >>> X = (50 - 30 * np.cos(t) * np.exp(-t / 20)).reshape(-1, 1)
    >>> y = 0.5 * X.ravel()
    >>> bool(HysteresisRegressor(levels=8).fit(X, y).score(X, y) > 0.999)
    True
    """

    def __init__(
        self,
        levels: int | Literal["auto"] = "auto",
        range: tuple[float, float] | None = None,
        operator: Literal["mkp", "kp", "relay"] = "mkp",
        solver: Literal["nnls", "ols"] = "nnls",
        smooth: float | tuple[float, float] | Literal["auto"] = "auto",
        ridge: float = 1e-6,
        robust: bool = True,
        start: Literal["auto", "off", "on", "rest", "unknown"] = "auto",
        sign: Literal[1, -1] | None = None,
        offset: float | None = None,
        bootstrap: int = 0,
        hold_out: str | None = None,
        column: int = 0,
        time_column: int | None = None,
        load_column: int | None = None,
        load_law: Literal["auto", "shift", "weights"] = "auto",
        load_degree: int | Literal["auto"] = "auto",
        spacing: Literal["auto", "uniform"] = "auto",
        delay: int | Literal["auto", "off"] = "auto",
        creep: int | Literal["auto", "off"] = "off",
        lag: float | Literal["auto", "off"] = "off",
        dynamics: Literal["auto", "off", "lag", "ring"] = "auto",
        curve: int | Literal["auto", "off"] = "off",
        thermal: Literal["first-order", "auto", True, False] | None = None,
    ) -> None:
        self.levels = levels
        self.range = range
        self.operator = operator
        self.solver = solver
        self.smooth = smooth
        self.ridge = ridge
        self.robust = robust
        self.start = start
        self.sign = sign
        self.offset = offset
        self.bootstrap = bootstrap
        self.hold_out = hold_out
        self.column = column
        self.time_column = time_column
        self.load_column = load_column
        self.load_law = load_law
        self.load_degree = load_degree
        self.spacing = spacing
        self.delay = delay
        self.creep = creep
        self.lag = lag
        self.dynamics = dynamics
        self.curve = curve
        self.thermal = thermal

    def fit(self, X: ArrayLike, y: Any, *, repeats: Any = None) -> HysteresisRegressor:
        """Identify the model.

        Parameters
        ----------
        X : array_like, shape (n, 1) or more columns
            The input, with time and load where there are columns for them, in the order in which
            it was sampled.
        y : array_like, shape (n,)
            The output.
        repeats : list of tuple, optional
            Pairs of `X` and `y` of other recordings of the same actuator. The weights are not fitted
            to them. The band of ``model_`` is widened to what changes between sessions.

        Returns
        -------
        HysteresisRegressor
            Itself.

        Examples
        --------
        >>> import numpy as np
        >>> from pyhysteron.sklearn import HysteresisRegressor
        >>> X = np.array([[0.0], [1.0], [2.0], [1.0], [0.0]])
        >>> HysteresisRegressor(levels=2).fit(X, [0, 1, 3, 3, 0]).model_.levels
        2
        """
        named = {"output_name": y.name} if isinstance(getattr(y, "name", None), str) else {}
        X, y = validate_data(self, X, y, y_numeric=True, dtype=np.float64, ensure_min_samples=2)
        options = {name: value for name, value in self.get_params().items() if not name.endswith("column")}
        input, around = self._series(X)
        if hasattr(self, "feature_names_in_"):
            names = self.feature_names_in_
            named["input_name"] = names[self.column]
            if self.load_column is not None:
                named["load_name"] = names[self.load_column]
        if repeats is not None:
            options["repeats"] = [self._repeat(X, y) for X, y in repeats]
        self.model_ = _hysteron.fit(_hysteron.Recording(input, y, **around, **named), **options)
        return self

    def predict(self, X: ArrayLike) -> NDArray[np.float64]:
        """The outputs, starting at the first row.

        Parameters
        ----------
        X : array_like, shape (n, 1) or more columns
            As for `fit`.

        Returns
        -------
        ndarray, shape (n,)

        Examples
        --------
        >>> import numpy as np
        >>> from pyhysteron.sklearn import HysteresisRegressor
        >>> X = np.array([[0.0], [1.0], [2.0], [1.0], [0.0]])
        >>> regressor = HysteresisRegressor(levels=2).fit(X, [0, 1, 3, 3, 0])
        >>> regressor.predict([[2.0], [1.0]]).round(3)
        array([3., 3.])
        """
        check_is_fitted(self)
        X = validate_data(self, X, reset=False, dtype=np.float64)
        input, around = self._series(X)
        start = self.start if self.start in ("off", "on") else "fitted"
        return self.model_.simulate(input, **around, start=start)

    def _repeat(self, X, y):
        X, y = validate_data(self, X, y, reset=False, y_numeric=True, dtype=np.float64)
        input, around = self._series(X)
        return _hysteron.Recording(input, y, **around)

    def _series(self, X):
        """The input, and time and load as far as there are columns for them."""
        around = {"time": self.time_column, "load": self.load_column}
        around = {name: _column(X, column, f"{name}_column") for name, column in around.items() if column is not None}
        return _column(X, self.column), around

    def __sklearn_tags__(self):
        tags = super().__sklearn_tags__()
        tags.regressor_tags.poor_score = True  # the checks' outputs are no function of one input's path
        return tags


def _column(X, column, name="column"):
    if not isinstance(column, numbers.Integral):
        raise TypeError(f"`{name}` is {column!r}: a whole number is needed")
    if not 0 <= column < X.shape[1]:
        raise ValueError(f"`{name}` is {column}, but `X` has {X.shape[1]} columns, counted from 0")
    return X[:, column]


class BranchSplit:
    """Leaves out runs of whole branches in turn, with what the operators remember before each run.

    The samples of one branch are alike. Leaving out some of them tests nothing, so a fold is a run
    of whole branches, with about as many samples in each fold. An operator depends on the past only
    through the turning points that no larger swing has wiped out (`pyhysteron.remembered`): two to
    a few dozen samples. They go before the fold in the test set, and before what follows the fold
    in the training set. So each operator has the same state after a fold as in the whole recording.

    This holds for the operators. Stages that depend on time remember the time itself: for a
    model that depends on time, leave out whole recordings instead.

    These few samples are in both sets, and the folds are no partition. `cross_val_score`,
    `cross_validate` and `GridSearchCV` accept that, `cross_val_predict` does not.
    `pyhysteron.left_out` needs no such samples.

    Parameters
    ----------
    n_splits : int
        How many folds, 2 at least.
    dead_band : float, optional
        Reversals of the input up to this size are noise, in its unit. By default 1 % of its range.
    column : int
        The column of `X` that is the input.

    Examples
    --------
    >>> import numpy as np
    >>> from pyhysteron.sklearn import BranchSplit
    >>> X = np.array([0, 4, 8, 5, 2, 5, 8, 4, 0.0]).reshape(-1, 1)
    >>> for train, test in BranchSplit(2).split(X):
    ...     print(train, test)
    [0 2 4 5 6 7 8] [0 1 2 3 4]
    [0 1 2 3 4] [0 2 4 5 6 7 8]
    """

    def __init__(self, n_splits: int = 5, *, dead_band: float | None = None, column: int = 0) -> None:
        self.n_splits = n_splits
        self.dead_band = dead_band
        self.column = column

    def get_n_splits(self, X: object = None, y: object = None, groups: object = None) -> int:
        """How many folds there are.

        Parameters
        ----------
        X, y, groups : object, optional
            Ignored.

        Returns
        -------
        int

        Examples
        --------
        >>> from pyhysteron.sklearn import BranchSplit
        >>> BranchSplit(4).get_n_splits()
        4
        """
        return self.n_splits

    def split(
        self, X: ArrayLike, y: object = None, groups: object = None
    ) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64]]]:
        """Indices of each fold.

        Parameters
        ----------
        X : array_like, shape (n, 1)
            The input, in the order in which it was sampled.
        y, groups : object, optional
            Ignored.

        Yields
        ------
        train, test : ndarray of int
            Ascending.

        Raises
        ------
        ValueError
            Where there are fewer branches than folds.

        Examples
        --------
        The last fold begins with the turning points that no larger swing has wiped out: 0, 8 and 1, not 6 and 7.

        >>> import numpy as np
        >>> from pyhysteron.sklearn import BranchSplit
        >>> X = np.array([0, 8, 6, 7, 1, 5, 3.0]).reshape(-1, 1)
        >>> train, test = list(BranchSplit(3).split(X))[-1]
        >>> X[test].ravel()
        array([0., 8., 1., 5., 3.])
        """
        input = _column(check_array(X, dtype=np.float64), self.column)
        starts = _starts(_hysteron.branches(input, dead_band=self.dead_band), self.n_splits)
        ends = [*starts[1:], len(input)]
        rows = np.arange(len(input))
        for start, end in zip(starts, ends):
            test = np.union1d(_hysteron.remembered(input[:start]), rows[start:end])
            after = rows[end:]
            before_it = _hysteron.remembered(input[:end]) if len(after) else rows[:0]
            train = np.union1d(np.union1d(rows[:start], before_it), after)
            yield train, test

    def __repr__(self):
        return f"BranchSplit(n_splits={self.n_splits}, dead_band={self.dead_band}, column={self.column})"


def _starts(branch, folds):
    """The first samples of runs of whole branches of about as many samples."""
    if not isinstance(folds, numbers.Integral):
        raise TypeError(f"`n_splits` is {folds!r}: a whole number is needed")
    if folds < 2:
        raise ValueError(f"`n_splits` is {folds}: 2 or more are needed")
    first = np.flatnonzero(np.diff(branch, prepend=-1))
    if len(first) < folds:
        raise ValueError(f"the input has {len(first)} branches, too few for {folds} folds: take a smaller `n_splits`")
    starts = [0]
    for fold in range(1, folds):
        # At least one branch for this fold and one for each that follows.
        open_ = first[first > starts[-1]]
        open_ = open_[: len(open_) - (folds - fold - 1)]
        starts.append(int(open_[np.argmin(np.abs(open_ - fold * len(branch) / folds))]))
    return starts
