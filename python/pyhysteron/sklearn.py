"""pyhysteron for scikit-learn: a regressor with memory, and a splitter that respects the memory.

A column of `X` is the input, and the rows are samples in the order in which they were taken. The output depends on that
order, as scikit-learn does not foresee: shuffled rows are another experiment. `predict` simulates from the start of what it is given, every
operator off (or on, with ``start='on'``). So a plain `KFold`, which hands over the middle of a recording without what came before,
scores the wrong experiment; `BranchSplit` hands over what the operators remember as well.
"""

import numbers

import numpy as np

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
    smooth : float or 'auto'
        Strength of the smoothness across the plane.
    start : {'off', 'on', 'unknown'}
        Where the operators stand before the first sample. 'unknown' is estimated in `fit`; `predict`, which has no output to
        tell it from, then sets out with every operator off.
    sign : {None, 1, -1}
    offset : float, optional
    bootstrap : int
        Replicates for `Model.confidence` and `Model.band` of ``model_``.
    column : int
        The column of `X` that is the input; others are not looked at.

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
        levels=20,
        range=None,
        operator="mkp",
        solver="nnls",
        smooth=0.0,
        start="off",
        sign=None,
        offset=None,
        bootstrap=0,
        column=0,
    ):
        self.levels = levels
        self.range = range
        self.operator = operator
        self.solver = solver
        self.smooth = smooth
        self.start = start
        self.sign = sign
        self.offset = offset
        self.bootstrap = bootstrap
        self.column = column

    def fit(self, X, y):
        """Identify the model.

        Parameters
        ----------
        X : array_like, shape (n, 1)
            The input, in the order in which it was sampled.
        y : array_like, shape (n,)
            The output.

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
        options = self.get_params()
        input = _column(X, options.pop("column"))
        if hasattr(self, "feature_names_in_"):
            named["input_name"] = self.feature_names_in_[self.column]
        self.model_ = _hysteron.fit(_hysteron.Recording(input, y, **named), **options)
        return self

    def predict(self, X):
        """The outputs, from the start of what is given.

        Parameters
        ----------
        X : array_like, shape (n, 1)
            The input, in the order in which it was sampled.

        Returns
        -------
        ndarray, shape (n,)

        Examples
        --------
        >>> import numpy as np
        >>> from pyhysteron.sklearn import HysteresisRegressor
        >>> X = np.array([[0.0], [1.0], [2.0], [1.0], [0.0]])
        >>> regressor = HysteresisRegressor(levels=2).fit(X, [0, 1, 3, 3, 0])
        >>> regressor.predict([[2.0], [1.0]]).round(6)
        array([3., 3.])
        """
        check_is_fitted(self)
        X = validate_data(self, X, reset=False, dtype=np.float64)
        return self.model_.start(on=self.start == "on").run(_column(X, self.column))

    def __sklearn_tags__(self):
        tags = super().__sklearn_tags__()
        tags.regressor_tags.poor_score = True  # the checks' outputs are no function of one input's path
        return tags


def _column(X, column):
    if not isinstance(column, numbers.Integral):
        raise TypeError(f"`column` is {column!r}: a whole number is needed")
    if not 0 <= column < X.shape[1]:
        raise ValueError(f"`column` is {column}, but `X` has {X.shape[1]} columns, counted from 0")
    return X[:, column]


class BranchSplit:
    """Leaves out runs of whole branches in turn, with what the operators remember before each run.

    The samples of one branch are so alike that leaving out some of them tests nothing; so a fold is a run of whole
    branches, about as many samples in each fold. What a hysteresis operator does depends on the past, but only on the few turning points that nothing
    since has wiped out (`pyhysteron.remembered`). These samples, some two to a few dozen, go before the fold in the test
    set, and before what follows the fold in the training set. Thus each operator stands after any fold exactly where it
    stands in the whole recording, and the model is fitted and scored on the material's own path.

    The price: those few samples are in both sets, so that the folds are no partition (`cross_val_score`, `cross_validate` and
    `GridSearchCV` take that, `cross_val_predict` does not). `pyhysteron.left_out` does without.

    Parameters
    ----------
    n_splits : int
        How many folds, 2 at least.
    band : float, optional
        Reversals of the input up to this are noise; by default 1 % of its range.
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

    def __init__(self, n_splits=5, *, band=None, column=0):
        self.n_splits = n_splits
        self.band = band
        self.column = column

    def get_n_splits(self, X=None, y=None, groups=None):
        """How many folds there are.

        Parameters
        ----------
        X, y, groups : object, optional
            Not looked at.

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

    def split(self, X, y=None, groups=None):
        """Indices of each fold.

        Parameters
        ----------
        X : array_like, shape (n, 1)
            The input, in the order in which it was sampled.
        y, groups : object, optional
            Not looked at.

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
        starts = _starts(_hysteron.branches(input, band=self.band), self.n_splits)
        ends = [*starts[1:], len(input)]
        rows = np.arange(len(input))
        for start, end in zip(starts, ends):
            test = np.union1d(_hysteron.remembered(input[:start]), rows[start:end])
            after = rows[end:]
            before_it = _hysteron.remembered(input[:end]) if len(after) else rows[:0]
            train = np.union1d(np.union1d(rows[:start], before_it), after)
            yield train, test

    def __repr__(self):
        return f"BranchSplit(n_splits={self.n_splits}, band={self.band}, column={self.column})"


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
