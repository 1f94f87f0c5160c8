"""Mutations: certificates changed at random, of which none may be accepted that states something false."""
