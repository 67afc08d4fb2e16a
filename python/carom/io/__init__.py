"""Shots of other programs: `carom.io.pooltool`."""
