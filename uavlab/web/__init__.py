"""Planners and flights as WebAssembly: the library's own compiled functions, for pages that answer without Python.

`functions` puts together what a page can ask, `build` makes `planners.wasm` of it, `planners.js` loads that in a page,
and `uavlab.scene.live` is the page. No planner is written a second time: what is compiled here is what runs in Python.
`generator` gives flights in a page the random numbers of `numpy.random.default_rng`.
"""
