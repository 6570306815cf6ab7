"""Planners and flights as WebAssembly, for pages that answer: made from the functions that the library compiles."""
