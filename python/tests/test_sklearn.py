import pickle
import warnings

import numpy as np
import pytest

import pyhysteron

pytest.importorskip("sklearn")

from sklearn.base import clone
from sklearn.model_selection import GridSearchCV, cross_val_score
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import FunctionTransformer
from sklearn.utils.estimator_checks import check_estimator

from pyhysteron.sklearn import EXPECTED_FAILED_CHECKS, BranchSplit, HysteresisRegressor


def test_check_estimator():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the checks' data have no hysteresis, and are told so
        results = check_estimator(HysteresisRegressor(), expected_failed_checks=EXPECTED_FAILED_CHECKS)
    assert {result["status"] for result in results} <= {"passed", "xfail", "skipped"}
    failed = [result["check_name"] for result in results if result["status"] == "xfail"]
    assert sorted(failed) == sorted(EXPECTED_FAILED_CHECKS), "one that passes is no expected failure"


@pytest.fixture(scope="module")
def data(recording):
    return recording.input.reshape(-1, 1), recording.output


def test_fit_predict_score_clone_pickle(data, recording):
    X, y = data
    regressor = HysteresisRegressor(levels=12, operator="kp")
    assert regressor.fit(X, y) is regressor
    model = pyhysteron.fit(recording.input, recording.output, levels=12, operator="kp", bootstrap=0)
    assert regressor.model_ == model
    np.testing.assert_array_equal(regressor.predict(X), model.simulate(recording.input))
    assert regressor.score(X, y) > 0.999
    again = pickle.loads(pickle.dumps(regressor))
    np.testing.assert_array_equal(again.predict(X), regressor.predict(X))
    assert clone(regressor).get_params() == regressor.get_params()
    assert not hasattr(clone(regressor), "model_")


def test_start_on_and_another_column(data):
    X, y = data
    wide = np.hstack([np.zeros_like(X), X])
    regressor = HysteresisRegressor(levels=5, column=1, start="on").fit(wide, y)
    np.testing.assert_array_equal(regressor.predict(wide), regressor.model_.start(on=True).run(X[:, 0]))
    with pytest.raises(ValueError, match="`column` is 1"):
        HysteresisRegressor(column=1).fit(X, y)


def test_bad_options_are_refused_at_fit(data):
    with pytest.raises(ValueError, match="`operator` is 'x'"):
        HysteresisRegressor(operator="x").fit(*data)


def test_folds_are_runs_of_whole_branches_after_what_is_remembered(data):
    X, _ = data
    branch = pyhysteron.branches(X[:, 0])
    folds = list(BranchSplit(5).split(X))
    assert len(folds) == BranchSplit(5).get_n_splits() == 5
    start = 0
    for train, test in folds:
        end = test[-1] + 1
        assert start == 0 or branch[start] == branch[start - 1] + 1
        fold = np.arange(start, end)
        others = np.setdiff1d(np.arange(len(X)), fold)
        assert 300 < len(fold) < 900
        assert (np.diff(train) > 0).all() and (np.diff(test) > 0).all()
        assert np.isin(fold, test).all() and np.isin(others, train).all()
        assert (np.setdiff1d(test, fold) < start).all()
        assert len(np.intersect1d(train, test)) < 30, "some turning points, no more"
        start = end
    assert start == len(X)


def test_operators_stand_in_a_fold_where_they_stand_in_the_recording(data, truth):
    X, _ = data
    whole = truth.simulate(X[:, 0])
    for rows in (rows for fold in BranchSplit(6).split(X) for rows in fold):
        np.testing.assert_array_equal(truth.simulate(X[rows, 0]), whole[rows])


def test_a_plain_fold_would_not(data, truth):
    X, _ = data
    whole = truth.simulate(X[:, 0])
    rows = slice(1700, 2300)
    assert np.abs(truth.simulate(X[rows, 0]) - whole[rows]).max() > 0.03


def test_grid_search(data):
    X, y = data
    search = GridSearchCV(HysteresisRegressor(), {"levels": [3, 12], "solver": ["nnls", "ols"]}, cv=BranchSplit(4))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", pyhysteron.HysteronWarning)
        search.fit(X, y)
        scores = cross_val_score(HysteresisRegressor(levels=12), X, y, cv=BranchSplit(4))
    assert search.best_params_["levels"] == 12
    assert search.best_score_ > 0.99
    assert scores.min() > 0.9


def test_pipeline(data):
    X, y = data
    both = make_pipeline(FunctionTransformer(lambda X: X / 10), HysteresisRegressor(levels=12))
    assert both.fit(X, y).score(X, y) > 0.999


@pytest.mark.parametrize("splits, message", [(1, "2 or more"), (1000, "branches, too few for 1000")])
def test_too_many_folds(data, splits, message):
    with pytest.raises(ValueError, match=message):
        next(BranchSplit(splits).split(data[0]))


def test_names_of_a_frame(data):
    pandas = pytest.importorskip("pandas")
    X, y = data
    frame = pandas.DataFrame({"room [degC]": 20.0, "wire [degC]": X[:, 0]})
    regressor = HysteresisRegressor(levels=5, column=1).fit(frame, pandas.Series(y, name="lift [mm]"))
    assert (regressor.model_.input, regressor.model_.output) == ("wire [degC]", "lift [mm]")


@pytest.mark.parametrize("column, error", [(1.0, TypeError), ("a", TypeError), (-1, ValueError), (1, ValueError)])
def test_a_column_that_is_not_there(data, column, error):
    X, y = data
    for use in (HysteresisRegressor(column=column).fit, lambda X, y: list(BranchSplit(column=column).split(X))):
        with pytest.raises(error, match=f"`column` is {column!r}"):
            use(X, y)


def test_hold_out_and_repeats(data):
    X, y = data
    tested = HysteresisRegressor(levels=8, hold_out="branches:20%").fit(X, y)
    assert tested.model_.fit.hold_out.model.samples > 0
    narrow = HysteresisRegressor(levels=8, bootstrap=20).fit(X, y)
    wide = HysteresisRegressor(levels=8, bootstrap=20).fit(X, y, repeats=[(X, y + 0.5)])
    np.testing.assert_array_equal(narrow.predict(X), wide.predict(X))
    assert wide.model_.confidence.noise > narrow.model_.confidence.noise
