"""JSON of the user's files. Knows nothing of Blender."""
import json


def read_json(path, failure):
    """failure: the exception that says what is wrong with the file, in words for the user."""
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except OSError as error:
        raise failure(f"{path}: {error.strerror}") from error
    except ValueError as error:
        raise failure(f"{path} is no JSON: {error}") from error
