"""Uses the package and prints what must have the same bits on every platform: `same.py CASE`."""

import hashlib
import json
import sys

import enmm

case = sys.argv[1]


def tell(name, data):
    print(name, hashlib.sha256(bytes(data)).hexdigest())


print("version", enmm.__version__, enmm.load_library().version)
with enmm.Model.from_file(case) as model:
    model.start()
    h = model.communication_step
    for k in range(10):
        model.do_step(k * h, h)
    state = model.save()
    model.set_gravity(0.5, -9.81)
    model.do_step(10 * h, h)
    tell("aside", model.serialize())
    model.restore(state)
    model.do_step(10 * h, h)
    tell("blocks", model.blocks(copy=True).tobytes())
    tell("contacts", model.contacts(copy=True).tobytes())
    tell("state", model.serialize())
with enmm.run(case) as result:
    tell("history", b"".join(result.history[name].tobytes() for name in result.history))
    tell("checkpoint", result.checkpoint.read_bytes())
tell("bound", json.dumps(enmm.bound(case), sort_keys=True).encode())
