"""Measurements that are published, each with its document, its page and its pictures."""
