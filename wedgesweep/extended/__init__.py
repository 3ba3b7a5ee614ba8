"""The suspension with effects that the base model's two states and five contacts cannot hold.

One general system for all of them: eight states, every piece of the equations smooth, every change of
piece a located switch. The same mechanics serve every solver:

    mode, unique = switching.initial(t, y, p)
    rate(t, y, mode, p, out), switches(t, y, mode, p, out), unique(t, y, mode, p)
    mode, unique = switching.successor(t, y, mode, switch, p)        may change y: a stop, an age
"""
