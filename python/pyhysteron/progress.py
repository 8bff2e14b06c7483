"""A progress bar for `progress=True`."""


class Bar:
    """Shows what is being done with tqdm, a bar for each stage."""

    def __init__(self):
        try:
            from tqdm.auto import tqdm
        except ImportError as error:
            raise ImportError("`progress=True` needs tqdm (pip install tqdm); or give a callable") from error
        self._tqdm = tqdm
        self._bar = None
        self._stage = None

    def __call__(self, stage, share):
        if stage != self._stage:
            self.close()
            self._bar = self._tqdm(total=100, desc=stage, unit="%", leave=False)
            self._stage = stage
        if share is not None:
            self._bar.update(round(100 * share) - self._bar.n)

    def close(self):
        if self._bar is not None:
            self._bar.close()
        self._bar = self._stage = None
