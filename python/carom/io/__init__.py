"""Shots for and from other programs: `carom.io.pooltool`."""
