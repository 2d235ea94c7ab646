"""A stand-in for preCICE: two participants in threads of one process, coupled serially and implicitly.

It has the calls of `Participant` of version 3 of the Python bindings that the adapter uses, with their rules: what must
be called when, and what is true when. The library itself is not among the packages that the tests can install. The
second participant's data are accelerated by Anderson's method (interface quasi-Newton with least squares). The
configuration is a JSON file: `first`, `second`, `mesh`, `to_first`, `to_second` (names of data), `window`, `end` (s),
`limit` (absolute change at which a window is done), `most` (iterations).
"""

import json
import threading
from pathlib import Path

import numpy as np

TIMEOUT = 60.0
_running: dict[str, "_Coupling"] = {}
_lock = threading.Lock()


class _Coupling:
    """What both participants share: the data of the windows, and whose turn it is."""

    def __init__(self, path):
        self.config = json.loads(Path(path).read_text(encoding="utf-8"))
        self.turn = threading.Condition()
        self.who = None
        self.positions, self.data, self.before = {}, {}, {}
        self.time, self.iteration, self.iterations = 0.0, 0, []
        self.inputs, self.residuals = [], []
        self.converged = False

    def pass_to(self, who):
        with self.turn:
            self.who = who
            self.turn.notify_all()

    def wait_for(self, who):
        with self.turn:
            if not self.turn.wait_for(lambda: self.who in (who, "broken"), TIMEOUT) or self.who == "broken":
                raise RuntimeError(f"{who} waited in vain for the other participant")

    def judge(self):
        """Ends the iteration of a window after the second participant: is it done, or what goes to the first next?"""
        name = self.config["to_first"]
        given, answer = self.accepted.ravel(), self.data[name].ravel()
        self.iteration += 1
        change = np.linalg.norm(answer - given)
        self.converged = change <= self.config["limit"]
        if self.converged:
            self.accepted = self.data[name]
            self.before = {data: values.copy() for data, values in self.data.items()}
            self.time += self.config["window"]
            self.iterations.append(self.iteration)
            self.iteration, self.inputs, self.residuals = 0, [], []
            return
        if self.iteration >= self.config["most"]:
            raise RuntimeError(f"the window at {self.time} s did not converge: it changes by {change}")
        self.inputs.append(given.copy())
        self.residuals.append(answer - given)
        following = answer
        if len(self.inputs) > 1:
            of_inputs = np.diff(np.array(self.inputs), axis=0).T
            of_residuals = np.diff(np.array(self.residuals), axis=0).T
            weights = np.linalg.lstsq(of_residuals, self.residuals[-1], rcond=1e-12)[0]
            following = answer - (of_inputs + of_residuals) @ weights
        self.accepted = following.reshape(self.data[name].shape)


class Participant:
    """One of the two participants."""

    def __init__(self, solver_name, configuration_file_name, solver_process_index, solver_process_size):
        assert (solver_process_index, solver_process_size) == (0, 1)
        with _lock:
            self._shared = _running.setdefault(configuration_file_name, _Coupling(configuration_file_name))
        config = self._shared.config
        assert solver_name in (config["first"], config["second"]), solver_name
        self._name, self._is_first = solver_name, solver_name == config["first"]
        self._other = config["second" if self._is_first else "first"]
        self._started, self._asked = False, {"write": True, "read": False}

    def get_mesh_dimensions(self, mesh_name):
        assert mesh_name == self._shared.config["mesh"]
        return 2

    def set_mesh_vertices(self, mesh_name, positions):
        assert not self._started, "vertices come before initialize"
        self._shared.positions[self._name] = np.array(positions)
        return np.arange(len(positions), dtype=np.int32)

    def requires_initial_data(self):
        return False

    def initialize(self):
        shared = self._shared
        self._started = True
        if self._is_first:
            shared.data = {
                shared.config[name]: np.zeros_like(shared.positions[self._name]) for name in ("to_first", "to_second")
            }
            shared.before = {name: values.copy() for name, values in shared.data.items()}
            shared.accepted = shared.data[shared.config["to_first"]]
            if shared.who is None:
                shared.pass_to(self._name)
        else:
            shared.wait_for(self._name)
            # Meshes of both sides are equal here, so that no mapping is needed.
            assert np.allclose(shared.positions[self._name], shared.positions[self._other])

    def is_coupling_ongoing(self):
        return self._shared.time < self._shared.config["end"] - 1e-12

    def requires_writing_checkpoint(self):
        asked, self._asked["write"] = self._asked["write"], False
        return asked

    def requires_reading_checkpoint(self):
        asked, self._asked["read"] = self._asked["read"], False
        return asked

    def get_max_time_step_size(self):
        return self._shared.config["window"]

    def read_data(self, mesh_name, data_name, vertex_ids, relative_read_time):
        shared, config = self._shared, self._shared.config
        assert self._started and mesh_name == config["mesh"]
        assert data_name == config["to_first" if self._is_first else "to_second"]
        assert 0.0 <= relative_read_time <= config["window"]
        end = shared.accepted if self._is_first else shared.data[data_name]
        share = relative_read_time / config["window"]
        return (1.0 - share) * shared.before[data_name][vertex_ids] + share * end[vertex_ids]

    def write_data(self, mesh_name, data_name, vertex_ids, values):
        assert data_name == self._shared.config["to_second" if self._is_first else "to_first"]
        assert np.shape(values) == (len(vertex_ids), 2)
        self._shared.data[data_name] = np.array(values)[vertex_ids]

    def advance(self, computed_time_step_size):
        shared = self._shared
        assert computed_time_step_size == shared.config["window"]
        assert not any(self._asked.values()), "checkpoints are to be asked for"
        if self._is_first:
            shared.pass_to(self._other)
            shared.wait_for(self._name)
        else:
            try:
                shared.judge()
            except RuntimeError:
                shared.pass_to("broken")
                raise
            self._converged_here = shared.converged
            shared.pass_to(self._other)
            if self.is_coupling_ongoing():
                shared.wait_for(self._name)
        converged = shared.converged if self._is_first else self._converged_here
        self._asked = {"write": converged, "read": not converged}

    def finalize(self):
        self._started = False
