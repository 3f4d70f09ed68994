"""Impacts in which nothing is missing, from laws and an integrator that nothing else here uses.

They set the thresholds of a diagnosis: what the comparison answers when only the contact law is
somewhat wrong. Nothing in this folder imports the project's laws, its integrator or its proof; the
baseline's curve comes in as plain numbers, to which each law is levelled.
"""
